// memory.cpp: what the kernel says of memory.
#include "base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

#include "base/error.h"

namespace espdiff {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The number in a file of the kernel's; `if_none` where there is no such file or no number ("max").
double number_in(const char* path, double if_none) {
  std::ifstream file(path);
  double value = 0;
  return file >> value ? value : if_none;
}

double available_in_machine() {
  std::ifstream file("/proc/meminfo");
  for (std::string key; file >> key;) {
    double kilobytes = 0;
    if (key == "MemAvailable:" && file >> kilobytes) return 1024 * kilobytes;
    std::getline(file, key);
  }
  return kUnlimited;
}

double left_in_group() {
  const double limit = number_in("/sys/fs/cgroup/memory.max", kUnlimited);
  return limit - number_in("/sys/fs/cgroup/memory.current", 0);
}

double left_in_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const double used = number_in("/proc/self/statm", 0) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return static_cast<double>(limit.rlim_cur) - used;
}

std::string gigabytes(double n_bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", std::max(0.0, n_bytes) / 1e9);
  return text;
}

}  // namespace

double available_memory() { return std::min({available_in_machine(), left_in_group(), left_in_address_space()}); }

void require_memory(double n_bytes, const std::string& what) {
  constexpr double kNotWorthALook = 64e6;
  if (n_bytes < kNotWorthALook) return;
  const double available = available_memory();
  if (n_bytes <= available) return;
  throw MemoryError(what + ": needs " + gigabytes(n_bytes) + " of memory, and " + gigabytes(available) +
                    " are available; give a smaller or coarser input, or free memory");
}

}  // namespace espdiff
