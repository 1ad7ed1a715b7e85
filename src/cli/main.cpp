// main.cpp: the program `espdiff`.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "cli/command_line.h"
#include "system/this_process.h"

namespace {

/// Whether the words ask for help or the version. Nothing is computed then, and half of the time would go into the
/// second start.
bool asks_for_text(int argc, char** argv) {
  const auto is_question = [](const char* word) {
    constexpr std::string_view kQuestions[] = {"-h", "--help", "--help-all", "-v", "--version"};
    return std::find(std::begin(kQuestions), std::end(kQuestions), word) != std::end(kQuestions);
  };
  return std::any_of(argv + std::min(argc, 1), argv + argc, is_question);
}

/// Sets OMP_WAIT_POLICY=passive and restarts the program. OpenMP threads spin while they wait unless told otherwise
/// before the start; on a busy machine that makes a run up to ten times as long. A user's own setting is kept.
void start_again_without_spinning(int argc, char** argv) {
  if (asks_for_text(argc, argv)) return;
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  espdiff::set_environment_default("OMP_WAIT_POLICY", "passive");
  espdiff::become_program("/proc/self/exe", {argv, argv + argc});  // returns only without /proc; threads then spin
}

}  // namespace

int main(int argc, char** argv) {
  start_again_without_spinning(argc, argv);
  espdiff::keep_large_arrays_apart();
  return espdiff::cli::run_command_line(argc, argv);
}
