// control_groups.h: the kernel's control groups that this process is in, and how many processors they leave it.
#pragma once

#include <string>
#include <vector>

namespace espdiff {

/// A control group of this process, or one above it.
struct ControlGroup {
  std::string folder;  ///< of its files
  bool is_version_2;
};

constexpr const char *kControlGroups = "/proc/self/cgroup", *kControlGroupMount = "/sys/fs/cgroup";

/// Those that may limit a controller, "memory" or "cpu", in both hierarchies: version 2, and version 1. Of those that a
/// container does not show, only the folders are made up.
/// @param group_file, mount the kernel's, but for tests
std::vector<ControlGroup> control_groups(const std::string& controller, const std::string& group_file = kControlGroups,
                                         const std::string& mount = kControlGroupMount);

/// Processors that this process may keep busy: those it may run on, or, where a control group has a share of time
/// (`docker run --cpus`), as many as that keeps busy, rounded up. At least 1.
int usable_processors(const std::string& group_file = kControlGroups, const std::string& mount = kControlGroupMount);

}  // namespace espdiff
