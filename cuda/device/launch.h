// launch.h: launches a stage's work on the device: a loop body per index, and the policy for Thrust's algorithms.
#pragma once

#include <cstddef>

#include "base/progress.h"
#include "base/vector.h"

#if defined(ESPDIFF_BACKEND_CUDA)
#include <thrust/system/cuda/execution_policy.h>

#include "cuda/device/cuda_context.h"
#else
#include <thrust/execution_policy.h>
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>
#endif

namespace espdiff::ESPDIFF_BACKEND {

// Each target wraps Thrust in its own namespace (THRUST_CUB_WRAPPED_NAMESPACE).
namespace thrust = THRUST_NS_QUALIFIER;

#if defined(ESPDIFF_BACKEND_CUDA)

/// Small blocks, so that a surface's 40,000 vertices occupy every multiprocessor of a large GPU.
constexpr unsigned kThreadsPerBlock = 128;

template <typename Body>
__global__ void __launch_bounds__(kThreadsPerBlock) for_each_kernel(std::size_t n, Body body) {
  const std::size_t i = static_cast<std::size_t>(blockIdx.x) * kThreadsPerBlock + threadIdx.x;
  if (i < n) body(i);
}

/// Calls body(i) for each i in [0, n) in parallel, after all work enqueued before. Returns before it is done.
/// Deterministic if no call writes what another reads or writes.
template <typename Body>
void for_each_index(std::size_t n, Body body) {
  if (n == 0) return;
  const std::size_t n_blocks = (n + kThreadsPerBlock - 1) / kThreadsPerBlock;
  for_each_kernel<<<static_cast<unsigned>(n_blocks), kThreadsPerBlock, 0, CudaContext::current()->stream()>>>(n, body);
  check_cuda(cudaGetLastError(), "starting a kernel");
}

/// Allocates the temporary memory of Thrust's algorithms from the engine's pool.
struct ScratchAllocator {
  using value_type = char;  // NOLINT(readability-identifier-naming): allocators name it so
  char* allocate(std::ptrdiff_t n) {
    return static_cast<char*>(CudaContext::current()->allocate(static_cast<std::size_t>(n)));
  }
  void deallocate(char* start, std::size_t) { CudaContext::current()->release(start); }
};

/// Execution policy for Thrust's algorithms: the engine's stream and pool. The algorithms may return before they are
/// done.
inline auto on_device() {
  static ScratchAllocator scratch;  // has no state
  return thrust::cuda::par_nosync(scratch).on(CudaContext::current()->stream());
}

#else

/// So many indices follow each other without a look at whether the computation is cancelled; fewer indices are each
/// looked at, since each may stand for much work.
constexpr std::size_t kIndicesAtOnce = 64, kFewIndices = 4096;

/// Calls body(i) for each i in [0, n) in parallel. Deterministic if no call writes what another reads or writes.
/// @throws Cancelled once this thread's CancelRequest is made, but not within another such loop; what the bodies write
/// is then unfinished
template <typename Body>
void for_each_index(std::size_t n, Body body) {
  if (n == 0) return;
  const CancelRequest cancel;
  const std::size_t at_once = n < kFewIndices ? 1 : kIndicesAtOnce;
  {
    const CancelRequest::Withheld within;
    thrust::for_each_n(thrust::device, thrust::counting_iterator<std::size_t>(0), (n + at_once - 1) / at_once,
                       [=](std::size_t block) {
                         if (cancel.made()) return;
                         const std::size_t end = block * at_once + at_once < n ? block * at_once + at_once : n;
                         for (std::size_t i = block * at_once; i < end; ++i) body(i);
                       });
  }
  cancel.check();
}

/// Execution policy for Thrust's algorithms.
inline auto on_device() { return thrust::device; }

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
