// memory.h: device memory of a back end: owned blocks, copies to and from the host, and the memory available.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#if defined(ESPDIFF_BACKEND_CUDA)
#include <memory>
#endif

namespace espdiff::ESPDIFF_BACKEND {

#if defined(ESPDIFF_BACKEND_CUDA)
class CudaContext;
#endif

/// Owns a block of uninitialized device memory. On the CPU it is heap memory aligned to a cache line. On a GPU it comes
/// from the pool of the engine whose call runs on this thread, is released in that engine's stream order, and may
/// outlive the engine.
class MemoryBlock {
 public:
  MemoryBlock() = default;
  /// @throws std::bad_alloc (CPU), MemoryError (GPU)
  explicit MemoryBlock(std::size_t n_bytes);
  MemoryBlock(MemoryBlock&& other) noexcept { swap(other); }
  MemoryBlock& operator=(MemoryBlock&& other) noexcept {
    MemoryBlock(std::move(other)).swap(*this);
    return *this;
  }
  MemoryBlock(const MemoryBlock&) = delete;
  MemoryBlock& operator=(const MemoryBlock&) = delete;
  ~MemoryBlock();

  void swap(MemoryBlock& other) noexcept {
    std::swap(start_, other.start_);
#if defined(ESPDIFF_BACKEND_CUDA)
    std::swap(context_, other.context_);
#endif
  }
  void* get() const { return start_; }

 private:
  void* start_ = nullptr;
#if defined(ESPDIFF_BACKEND_CUDA)
  std::shared_ptr<CudaContext> context_;
#endif
};

/// Copies from the host; `from` may change as soon as the call returns.
void copy_to_device(void* to, const void* from, std::size_t n_bytes);
/// Copies to the host after all work enqueued before.
void copy_to_host(void* to, const void* from, std::size_t n_bytes);
void copy_on_device(void* to, const void* from, std::size_t n_bytes);

/// Copies to the host that are waited for together.
class HostReads {
 public:
  HostReads();
#if defined(ESPDIFF_BACKEND_CUDA)
  /// Drops what was not waited for. On the CPU nothing is left to drop.
  ~HostReads();
#endif
  HostReads(const HostReads&) = delete;
  HostReads& operator=(const HostReads&) = delete;
  /// Enqueues a copy of what `from` holds after all work enqueued before. wait() sets `to`.
  void add(void* to, const void* from, std::size_t n_bytes);
  void wait();

#if defined(ESPDIFF_BACKEND_CUDA)
 private:
  std::shared_ptr<CudaContext> context_;
#endif
};

/// Bytes that can still be taken: available_memory() on the CPU; 90 % of a GPU's memory that is free or unused in the
/// engine's pool.
double available_bytes();

/// Stages say before they begin what they will hold, so that what does not fit is refused at once, in words, and what
/// fits is not.
/// @param bytes_per_point of all that the stage itself allocates and holds at one time; not what is there already
/// @returns how many times as coarse (in spacing) the grid must be to fit; 1 where it fits as it is. A need below
/// 64 MB is not looked at. Grids are limited to 2e9 points whatever memory there is, for their indices.
double coarsening_to_fit(double n_points, double bytes_per_point);

/// The same as a check. `what` begins the message: "gradient vector flow".
/// @throws MemoryError with need, available memory and remedy
void require_grid(double n_points, double bytes_per_point, const std::string& what);

/// "needs 12.3 GB of memory, and 3.1 GB are available": the middle of such a message.
std::string need_in_words(double n_points, double bytes_per_point);

}  // namespace espdiff::ESPDIFF_BACKEND
