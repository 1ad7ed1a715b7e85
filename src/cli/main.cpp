// main.cpp: the program `espdiff`.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "cli/command_line.h"
#include "engine/compute_thread.h"
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

/// Restarts the program with settings that its libraries read before `main` only. A user's own settings are kept.
void start_again_with_settings(int argc, char** argv) {
  if (asks_for_text(argc, argv)) return;
  bool is_new = false;
  if (std::getenv("GOMP_SPINCOUNT") == nullptr && std::getenv("OMP_WAIT_POLICY") == nullptr) {
    espdiff::set_environment_default("GOMP_SPINCOUNT", espdiff::kBriefSpins);
    is_new = espdiff::set_environment_default("OMP_WAIT_POLICY", "passive");  // of other libraries than libgomp
  }
  // Huge pages for glibc's heap: the kernel takes a tenth of a pair's time to hand out small ones.
  is_new = espdiff::set_environment_default("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1") || is_new;
  if (is_new) espdiff::become_program("/proc/self/exe", {argv, argv + argc});  // returns only without /proc
}

}  // namespace

int main(int argc, char** argv) {
  start_again_with_settings(argc, argv);
  espdiff::keep_large_arrays_apart();
  return espdiff::cli::run_command_line(argc, argv);
}
