// memory.h: asks whether memory is there before it is taken.
#pragma once

#include <string>

namespace espdiff {

/// Bytes that this process can still take: what the kernel calls available, or what is left of a limit on its control
/// group or its address space, whichever is least. Infinite where nothing tells.
double available_memory();

/// Linux grants memory that it does not have and kills who uses it, so a large need is checked first. Needs below
/// 64 MB pass without a look. `what` begins the message: a path, or what is being computed.
/// @throws MemoryError with the need, what is available, and what to do
void require_memory(double n_bytes, const std::string& what);

}  // namespace espdiff
