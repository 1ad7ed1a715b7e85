// memory_checks.h: what compute-sanitizer would look for, where there is no GPU: accesses out of bounds or misaligned,
// loads of what was never written, and threads that touch the same memory in an order that nothing defines.
//
// Races are looked for in kernels without barriers, byte by byte within a launch, but for accesses that are atomic or
// volatile. What is found is printed once for each kernel and kind, and counted; a program with findings ends with 3.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cuda_emulator {

extern bool checking;  ///< settings().check, once the device has memory

void note_load(const char* place, std::size_t n_bytes, bool strong);
/// value: the bytes that are stored; null where they are not known.
void note_store(const char* place, std::size_t n_bytes, const void* value, bool strong);

/// A launch begins; threads are distinguished by their number in the grid.
void begin_launch(bool look_for_races);
void begin_thread(std::uint64_t number);

void mark_allocated(const char* start, std::size_t n_bytes);
void mark_released(const char* start, std::size_t n_bytes);

}  // namespace cuda_emulator
