// this_process.cpp: what the kernel says of this process and its children.
#include "system/this_process.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "support/limit_memory.h"
#include "support/test_data.h"
#include "system/child_process.h"
#include "system/permissions.h"
#include "system/shared_library.h"

using namespace espdiff;
using espdiff_test::ScratchFolder;

namespace {

/// Waits for a child, at most a minute.
ChildState state_at_end(int process, int& status) {
  for (int i = 0; i < 6000; ++i) {
    const ChildState state = child_state(process, status);
    if (state != ChildState::kRunning) return state;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return ChildState::kRunning;
}

std::uint64_t resident_bytes() {
  std::ifstream pages("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  pages >> all >> resident;
  return resident * memory_page_size();
}

}  // namespace

TEST_CASE("this_process: its number, its program, its environment") {
  CHECK(is_process(process_number()));
  CHECK(own_program().find("test_system") != std::string::npos);
  CHECK(set_environment_default("ESPDIFF_TEST_DEFAULT", "first"));
  CHECK_FALSE(set_environment_default("ESPDIFF_TEST_DEFAULT", "second"));
  CHECK(std::string(std::getenv("ESPDIFF_TEST_DEFAULT")) == "first");
  CHECK(become_program("no-such-program-1", {"no-such-program-1"}) == ENOENT);
  CHECK(memory_page_size() >= 1024);
}

TEST_CASE("child_process: a detached program writes its log, and its end is told once") {
  const ScratchFolder folder;
  int process = 0, status = 0;
  REQUIRE(start_detached({"sh", "-c", "echo out; echo err >&2; exit 5"}, folder.file("log"), process) == 0);
  CHECK(state_at_end(process, status) == ChildState::kEnded);
  CHECK(status == 5);
  CHECK(child_state(process, status) == ChildState::kUnknown);
  CHECK_FALSE(is_process(process));
  std::ifstream log(folder.file("log"));
  std::string first, second;
  log >> first >> second;
  CHECK(first + " " + second == "out err");
  CHECK(start_detached({"no-such-program-1"}, folder.file("log"), process) == ENOENT);
}

#if defined(__GLIBC__)
TEST_CASE("this_process: large arrays go back to the system when they are freed, in any order") {
  if (!espdiff_test::can_limit_memory()) return;
  keep_large_arrays_apart();
  const std::uint64_t before = resident_bytes();
  constexpr std::size_t kLarge = 40 << 20;
  for (int i = 0; i < 4; ++i) {
    auto first = std::make_unique<std::vector<char>>(kLarge, 'a');
    const std::vector<char> small(100000, 'b');
    CHECK(resident_bytes() > before + kLarge / 2);
    first.reset();
    CHECK(resident_bytes() < before + kLarge / 2);
  }
}

TEST_CASE("this_process: smaller arrays keep their pages when they are freed") {
  if (!espdiff_test::can_limit_memory()) return;
  keep_large_arrays_apart();
  constexpr std::size_t kArray = 3 << 20;
  const auto make = [&] { std::make_unique<std::vector<char>>(kArray, 'a').reset(); };
  make();
  rusage first{}, second{};
  getrusage(RUSAGE_SELF, &first);
  make();
  getrusage(RUSAGE_SELF, &second);
  CHECK(static_cast<std::size_t>(second.ru_minflt - first.ru_minflt) * memory_page_size() < kArray / 2);
}
#endif

TEST_CASE("permissions: a private folder is this user's, a link to it is not") {
  const ScratchFolder folder;
  const std::string made = make_private_folder(folder.file("start-"));
  CHECK(made.find("start-") != std::string::npos);
  CHECK(is_own_folder(made));
  std::filesystem::create_directory_symlink(made, folder.file("link"));
  CHECK_FALSE(is_own_folder(folder.file("link")));
  CHECK(make_private_folder(folder.file("absent/start-")).empty());
  CHECK(may_write(made));
  CHECK_FALSE(may_run(made));  // a folder
  CHECK(may_run(own_program()));
}

TEST_CASE("shared_library: one that is there, one that is not, and a missing function") {
  void* const library = load_library("libm.so.6", LibraryUse::kOwn);
  REQUIRE(library != nullptr);
  CHECK(find_function<double (*)(double)>(library, "sqrt")(9.0) == 3.0);
  CHECK(find_symbol(library, "no_such_function_1") == nullptr);
  CHECK(load_library("libno-such-library-1.so", LibraryUse::kLazy) == nullptr);
}
