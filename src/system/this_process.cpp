// this_process.cpp: what the kernel knows of this process.
#include "system/this_process.h"

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace espdiff {

int process_number() { return static_cast<int>(::getpid()); }

bool is_process(int number) { return ::kill(static_cast<pid_t>(number), 0) == 0 || errno != ESRCH; }

std::string own_program() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::string() : program.string();
}

void set_environment_default(const char* name, const char* value) {
  ::setenv(name, value, 0);  // NOLINT(concurrency-mt-unsafe): the header says when
}

int become_program(const std::string& program, const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::execvp(program.c_str(), arguments.data());
  return errno;
}

std::uint64_t address_space_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return UINT64_MAX;
  return limit.rlim_cur;
}

std::uint64_t memory_page_size() { return static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)); }

std::uint64_t allocated_bytes() {
#if defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 33)
  const struct mallinfo2 heap = ::mallinfo2();
  return heap.uordblks + heap.hblkhd;
#endif
#endif
  return 0;
}

void return_free_memory() {
#if defined(__GLIBC__)
  ::malloc_trim(0);
#endif
}

#if defined(__GLIBC__)
namespace {

constexpr int kLarge = 1 << 20, kLargest = 1 << 25;  // in bytes; the latter is glibc's limit
std::atomic<int> size_of_own_pages{0};

/// Arrays of this size get pages of their own, and at most four times as much free memory is kept.
void set_size_of_own_pages(int size) {
  if (size_of_own_pages.exchange(size) == size) return;
  if (std::getenv("MALLOC_MMAP_THRESHOLD_") == nullptr) ::mallopt(M_MMAP_THRESHOLD, size);
  if (std::getenv("MALLOC_TRIM_THRESHOLD_") == nullptr) ::mallopt(M_TRIM_THRESHOLD, 4 * size);
}

}  // namespace

void keep_large_arrays_apart() { set_size_of_own_pages(kLarge); }

void keep_larger_arrays_apart() {
  constexpr std::uint64_t kShare = 16;
  if (size_of_own_pages == 0) return;
  const std::uint64_t part = allocated_bytes() / kShare;
  set_size_of_own_pages(static_cast<int>(std::clamp<std::uint64_t>(part, kLarge, kLargest)));
}
#else
void keep_large_arrays_apart() {}
void keep_larger_arrays_apart() {}
#endif

}  // namespace espdiff
