// cuda_context.h: an engine's resources on its GPU: a stream, a memory pool, and a staging area for transfers.
//
// Other CUDA code may run in the process (VMD's). So the stream is neither the default one nor synchronized with it,
// the pool is not the device's default pool, the device is never reset, and each call restores the thread's current
// device.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cuda/device/cuda_errors.h"

namespace espdiff::ESPDIFF_BACKEND {

/// An engine's resources on one device. One thread at a time uses an engine; any thread may release memory.
class CudaContext {
 public:
  /// @throws DeviceError if the device does not work or this build has no code for it
  explicit CudaContext(int device);
  ~CudaContext();
  CudaContext(const CudaContext&) = delete;
  CudaContext& operator=(const CudaContext&) = delete;

  /// The context of the engine whose call runs on this thread.
  /// @throws Error (internal) outside an engine's call
  static const std::shared_ptr<CudaContext>& current();

  /// While it lives, `context` is current on this thread and its device is the runtime's current device.
  class Use {
   public:
    explicit Use(const std::shared_ptr<CudaContext>& context);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    const std::shared_ptr<CudaContext>* before_;
    int device_before_ = 0;
  };

  int device() const { return device_; }
  /// For enqueuing work, for which synchronize() then waits.
  cudaStream_t stream() {
    pending_ = true;
    return stream_;
  }

  /// Allocates memory for later work on the stream. Comes from the pool, which keeps released memory, so a second run
  /// of the same size does not call the driver; from the device if it has no pools.
  /// @throws MemoryError
  void* allocate(std::size_t n_bytes);
  /// Frees the memory for work enqueued later.
  void release(void* start) noexcept;

  void upload(void* to, const void* from, std::size_t n_bytes);
  void copy(void* to, const void* from, std::size_t n_bytes);
  /// Enqueues a copy to the host; the next synchronize() sets `to`, unless forget_reads() is called before.
  void begin_read(void* to, const void* from, std::size_t n_bytes);
  void forget_reads() noexcept { reads_.clear(); }

  /// Waits for all enqueued work; returns at once if there is none since the last wait.
  /// @throws DeviceError if any of that work failed
  void synchronize();

  /// GPU time in milliseconds of the work that `calls` enqueues.
  double elapsed_ms(const std::function<void()>& calls);

  /// Bytes of the device that the pool holds, in use or not; 0 without a pool.
  double reserved_bytes() const;
  /// Bytes that can still be allocated.
  double available_bytes() const;

 private:
  cudaError_t try_allocate(void** start, std::size_t n_bytes);
  /// Room in the staging area; null if `n_bytes` do not fit.
  char* stage(std::size_t n_bytes);

  int device_;
  cudaStream_t stream_ = nullptr;
  cudaMemPool_t pool_ = nullptr;  ///< null where the device has no pools
  char* staging_ = nullptr;       ///< pinned, so transfers are asynchronous and copied once; null for none
  std::size_t n_staged_ = 0;
  /// Copies to the host that lie in the staging area until the next wait.
  struct Read {
    void* to;
    const char* staged;
    std::size_t n_bytes;
  };
  std::vector<Read> reads_;
  bool pending_ = false;  ///< work was enqueued since the last wait
};

/// "NVIDIA H200 (compute capability 9.0, 139.81 GiB)"
std::string describe_device(int device);

/// Facts about the runtime's current device, for messages; makes no call that could fail again.
CudaFacts facts_of_current_device(std::size_t asked_bytes = 0);

}  // namespace espdiff::ESPDIFF_BACKEND
