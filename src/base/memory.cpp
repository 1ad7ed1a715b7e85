// memory.cpp: what the kernel says of memory.
#include "base/memory.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/formatted.h"
#include "system/control_groups.h"
#include "system/this_process.h"

namespace espdiff {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The number in a file of the kernel's; `if_none` where there is no such file or no number ("max").
double number_in(const std::string& path, double if_none) {
  std::ifstream file(path);
  double value = 0;
  return file >> value ? value : if_none;
}

/// The number behind a key at a line's start.
double number_behind(const std::string& path, const std::string& wanted, double if_none) {
  std::ifstream file(path);
  for (std::string key, rest; file >> key; std::getline(file, rest)) {
    double value = 0;
    if (key == wanted && file >> value) return value;
  }
  return if_none;
}

double available_in_machine() { return 1024 * number_behind("/proc/meminfo", "MemAvailable:", kUnlimited); }

/// Names of a control group's files.
struct GroupFiles {
  const char *limit, *used, *droppable;
};
constexpr GroupFiles kVersion2 = {"/memory.max", "/memory.current", "inactive_file"};
constexpr GroupFiles kVersion1 = {"/memory.limit_in_bytes", "/memory.usage_in_bytes", "total_inactive_file"};

double left_in(const std::string& group, const GroupFiles& files) {
  const double limit = number_in(group + files.limit, kUnlimited);
  if (limit == kUnlimited) return kUnlimited;
  const double used = number_in(group + files.used, 0);
  return limit - used + std::min(used, number_behind(group + "/memory.stat", files.droppable, 0));
}

double left_in_address_space() {
  const std::uint64_t limit = address_space_limit();
  if (limit == UINT64_MAX) return kUnlimited;
  const double used = number_in("/proc/self/statm", 0) * static_cast<double>(memory_page_size());
  return static_cast<double>(limit) - used;
}

std::string gigabytes(double n_bytes) { return formatted("%.1f GB", std::max(0.0, n_bytes) / 1e9); }

}  // namespace

double left_in_groups(const std::string& group_file, const std::string& mount) {
  double least = kUnlimited;
  for (const ControlGroup& group : control_groups("memory", group_file, mount))
    least = std::min(least, left_in(group.folder, group.is_version_2 ? kVersion2 : kVersion1));
  return least;
}

double available_memory() {
  return std::min(
      {available_in_machine(), left_in_groups(kControlGroups, kControlGroupMount), left_in_address_space()});
}

void require_memory(double n_bytes, const std::string& what) {
  constexpr double kNotWorthALook = 64e6;
  if (n_bytes < kNotWorthALook) return;
  const double available = available_memory();
  if (n_bytes <= available) return;
  throw MemoryError(what + ": needs " + gigabytes(n_bytes) + " of memory, and " + gigabytes(available) +
                    " are available; give a smaller or coarser input, or free memory");
}

}  // namespace espdiff
