// cuda_context.h: what an engine has on its GPU: a stream, a pool of memory, and a staging area for transfers.
//
// Other CUDA code may live in the process (VMD's). Hence the stream is not the default one and does not wait for it,
// the pool is not the device's default one, the device is never reset, and the thread's current device is put back
// after each call.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "cuda/device/cuda_errors.h"

namespace espdiff::ESPDIFF_BACKEND {

/// An engine's means on one device. An engine is used by one thread at a time; memory may be released by any.
class CudaContext {
 public:
  /// @throws DeviceError where the device does not work, or this build has no code for it
  explicit CudaContext(int device);
  ~CudaContext();
  CudaContext(const CudaContext&) = delete;
  CudaContext& operator=(const CudaContext&) = delete;

  /// That of the engine whose call runs on this thread.
  /// @throws Error (internal) outside a call
  static const std::shared_ptr<CudaContext>& current();

  /// While it lives, `context` is the current one of this thread, and its device the runtime's.
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
  cudaStream_t stream() const { return stream_; }

  /// Memory that later work on the stream may use. Taken from the pool, which keeps what is released, so that a second
  /// run of the same size asks the driver for nothing; where the device has no pools, from the device.
  /// @throws MemoryError
  void* allocate(std::size_t n_bytes);
  /// To be used again by work that is asked for later.
  void release(void* start) noexcept;

  void upload(void* to, const void* from, std::size_t n_bytes);
  void download(void* to, const void* from, std::size_t n_bytes);
  void copy(void* to, const void* from, std::size_t n_bytes);

  /// Waits for all that was asked for.
  /// @throws DeviceError what failed meanwhile
  void synchronize();

  /// Milliseconds from an event before the work that `calls` asks for to one behind it.
  double elapsed_ms(const std::function<void()>& calls);

  /// Bytes that can still be allocated.
  double available_bytes() const;

 private:
  cudaError_t try_allocate(void** start, std::size_t n_bytes);
  /// Room in the staging area; null where `n_bytes` are too many for it.
  char* stage(std::size_t n_bytes);

  int device_;
  cudaStream_t stream_ = nullptr;
  cudaMemPool_t pool_ = nullptr;  ///< null where the device has no pools
  char* staging_ = nullptr;       ///< pinned, so that transfers neither wait nor are copied twice; null for none
  std::size_t n_staged_ = 0;
};

/// "NVIDIA H200 (compute capability 9.0, 139.81 GiB)"
std::string describe_device(int device);

/// Of the runtime's current device, for messages; asks nothing that could fail again.
CudaFacts facts_of_current_device(std::size_t asked_bytes = 0);

}  // namespace espdiff::ESPDIFF_BACKEND
