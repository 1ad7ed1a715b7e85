// main.cpp: the program `espdiff`.
#include <cstdlib>

#include "cli/command_line.h"
#include "system/this_process.h"

namespace {

/// Sets OMP_WAIT_POLICY=passive and restarts the program. OpenMP threads spin while they wait unless told otherwise
/// before the start; on a busy machine that makes a run up to ten times as long. A user's own setting is kept.
void start_again_without_spinning(int argc, char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  espdiff::set_environment_default("OMP_WAIT_POLICY", "passive");
  espdiff::become_program("/proc/self/exe", {argv, argv + argc});  // returns only without /proc; threads then spin
}

}  // namespace

int main(int argc, char** argv) {
  start_again_without_spinning(argc, argv);
  return espdiff::cli::run_command_line(argc, argv);
}
