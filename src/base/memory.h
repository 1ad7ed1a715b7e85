// memory.h: asks whether memory is there before it is taken.
#pragma once

#include <string>

namespace espdiff {

/// Bytes that this process can still take: what the kernel calls available, or what is left of a limit on its control
/// group or its address space, whichever is least. Infinite where nothing tells.
double available_memory();

/// What the limits on this process' control groups leave, each less what its group holds but for file pages that the
/// kernel drops first. Both hierarchies are read: version 2, and version 1 (`memory`). Each group's parents count as
/// well; those that a container does not show do not.
/// @param group_file, mount the kernel's /proc/self/cgroup and /sys/fs/cgroup, but for tests
double left_in_groups(const std::string& group_file, const std::string& mount);

/// Linux grants memory that it does not have and kills who uses it, so a large need is checked first. Needs below
/// 64 MB pass without a look. `what` begins the message: a path, or what is being computed.
/// @throws MemoryError with the need, what is available, and what to do
void require_memory(double n_bytes, const std::string& what);

}  // namespace espdiff
