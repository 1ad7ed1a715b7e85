// main.cpp: the program `espdiff`.
#include <unistd.h>

#include <cstdlib>

#include "cli/command_line.h"

namespace {

/// Sets OMP_WAIT_POLICY=passive and restarts the program. OpenMP threads spin while they wait unless told otherwise
/// before the start; on a busy machine that makes a run up to ten times as long. A user's own setting is kept.
void start_again_without_spinning(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  setenv("OMP_WAIT_POLICY", "passive", 1);  // NOLINT(concurrency-mt-unsafe): no other thread exists yet
  execv("/proc/self/exe", argv);            // returns only without /proc; threads then spin
}

}  // namespace

int main(int argc, char** argv) {
  start_again_without_spinning(argv);
  return espdiff::cli::run_command_line(argc, argv);
}
