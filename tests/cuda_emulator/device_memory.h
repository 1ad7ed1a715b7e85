// device_memory.h: the memory of the device that is not there.
//
// It is mapped twice. What the program gets as device pointers are addresses that nothing may touch: a host function
// that follows one dies, as it would with a GPU. Kernels and copies go through a view of the same memory elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cuda_emulator {

constexpr std::size_t kRedZone = 512;  ///< bytes around an allocation that nobody may write

extern char* device_begin;  ///< as device pointers have it
extern std::size_t device_size;
extern std::ptrdiff_t to_view;

inline bool on_device(const void* place) {
  return static_cast<std::size_t>(static_cast<const char*>(place) - device_begin) < device_size;
}

/// Where the host may read and write what a pointer of any kind points to.
template <typename T>
T* view(T* place) {
  return on_device(place)
             ? reinterpret_cast<T*>(reinterpret_cast<std::uintptr_t>(place) + static_cast<std::uintptr_t>(to_view))
             : place;
}

constexpr int kNewMemory = 0xAB;  ///< in each byte of memory that was just given, so that a read of it shows

/// Null where the device is full.
char* allocate(std::size_t n_bytes);

/// Fails where nothing is allocated there, or something wrote beside the allocation.
void release(char* start);

/// Whether all n bytes lie in one allocation, or none on the device.
bool allocated(const void* start, std::size_t n_bytes);

std::size_t allocated_bytes();

// What the checks know of each byte on the device (settings().check).

/// Whoever looks at memory for the program: a kernel's thread, a copy, a library.
void mark_written(const void* start, std::size_t n_bytes);

/// From one place to another; either may be the host's, whose bytes count as written.
void mark_copied(const void* to, const void* from, std::size_t n_bytes);

}  // namespace cuda_emulator
