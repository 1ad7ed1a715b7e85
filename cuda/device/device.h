// device.h: the back end's namespace, its buffers, and the parallel primitives that all stages use.
//
// Every .cu is compiled twice: with ESPDIFF_BACKEND=cpu_backend by g++ (Thrust's OpenMP device system) and with
// ESPDIFF_BACKEND=cuda_backend by nvcc. The namespace keeps the two sets of inline functions apart.
#pragma once

#include <thrust/scan.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "base/vector.h"
#include "cuda/device/buffer.h"
#include "cuda/device/launch.h"

// Compiles a hot host function for several instruction sets and picks one at load time. Without contraction all
// versions give the same bits. The levels name features; a processor's name would only match that vendor's.
#if defined(__GNUC__) && !defined(__CUDACC__) && defined(__x86_64__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define ESPDIFF_MULTIVERSION __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ESPDIFF_MULTIVERSION
#endif
#if defined(__CUDACC__)
#define ESPDIFF_INLINE __host__ __device__ __forceinline__
#define ESPDIFF_INLINE_LAMBDA
#else
#define ESPDIFF_INLINE inline __attribute__((always_inline))
#define ESPDIFF_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace espdiff::ESPDIFF_BACKEND {

constexpr std::size_t kReductionChunk = 2048;

#if defined(ESPDIFF_BACKEND_CUDA)

constexpr unsigned kReductionThreads = 128;

/// Sums term(i) over [begin, end) in a block of kReductionThreads threads. The order depends on the range only: each
/// thread adds a strided share, then the threads' sums are halved pairwise. Thread 0 writes the sum.
template <typename T, typename Term>
__device__ void block_sum(std::size_t begin, std::size_t end, const Term& term, T* out) {
  // Raw memory, because T may have a constructor.
  __shared__ __align__(16) unsigned char shared[kReductionThreads * sizeof(T)];
  T* const sums = reinterpret_cast<T*>(shared);
  T sum{};
  for (std::size_t i = begin + threadIdx.x; i < end; i += kReductionThreads) sum += term(i);
  sums[threadIdx.x] = sum;
  for (unsigned half = kReductionThreads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) sums[threadIdx.x] += sums[threadIdx.x + half];
  }
  if (threadIdx.x == 0) *out = sums[0];
}

template <typename T, typename Term>
__global__ void __launch_bounds__(kReductionThreads) sum_chunks_kernel(std::size_t n, Term term, T* partial) {
  const std::size_t begin = blockIdx.x * kReductionChunk;
  block_sum<T>(begin, begin + kReductionChunk < n ? begin + kReductionChunk : n, term, partial + blockIdx.x);
}

/// Reads an array's elements as terms.
template <typename T>
struct ElementOf {
  const T* values;
  __device__ T operator()(std::size_t i) const { return values[i]; }
};

template <typename T>
__global__ void __launch_bounds__(kReductionThreads) sum_partial_kernel(std::size_t n, const T* partial, T* total) {
  block_sum<T>(0, n, ElementOf<T>{partial}, total);
}

/// Sum of term(i) over [0, n) as a T (with operator+=, value-initialized to zero). Bitwise reproducible: sums chunks of
/// fixed size, then the chunks.
template <typename T, typename Term>
T sum_over(std::size_t n, Term term) {
  if (n == 0) return T{};
  const std::size_t n_chunks = (n + kReductionChunk - 1) / kReductionChunk;
  Buffer<T> partial(n_chunks + 1);  // the last one is the total
  const cudaStream_t stream = CudaContext::current()->stream();
  sum_chunks_kernel<<<static_cast<unsigned>(n_chunks), kReductionThreads, 0, stream>>>(n, term, raw(partial));
  sum_partial_kernel<<<1, kReductionThreads, 0, stream>>>(n_chunks, raw(partial), raw(partial) + n_chunks);
  check_cuda(cudaGetLastError(), "starting a sum");
  return partial.back();
}

#else

/// Sum of term(i) over [0, n) as a T (with operator+=, value-initialized to zero). Adds chunks of fixed size in order,
/// then the chunks in order, so the result does not depend on the number of threads.
template <typename T, typename Term>
T sum_over(std::size_t n, Term term) {
  const std::size_t n_chunks = (n + kReductionChunk - 1) / kReductionChunk;
  Buffer<T> partial(n_chunks);
  T* const partial_sums = raw(partial);
  for_each_index(n_chunks, [=] ESPDIFF_HD(std::size_t chunk) {
    T sum{};
    const std::size_t end = (chunk + 1) * kReductionChunk < n ? (chunk + 1) * kReductionChunk : n;
    for (std::size_t i = chunk * kReductionChunk; i < end; ++i) sum += term(i);
    partial_sums[chunk] = sum;
  });
  T total{};
  for (const T& sum : to_host(partial)) total += sum;
  return total;
}

#endif

/// Exclusive prefix sum, in place.
template <typename T>
void running_sum_in_place(Buffer<T>& counts) {
  if (!counts.empty()) thrust::exclusive_scan(on_device(), counts.begin(), counts.end(), counts.begin());
}

/// Exclusive prefix sum, in place; waits for the total and returns it.
template <typename T>
T exclusive_scan_in_place(Buffer<T>& counts) {
  if (counts.empty()) return T{};
  const T last = counts.back();
  running_sum_in_place(counts);
  return static_cast<T>(counts.back() + last);
}

/// The larger and the smaller of two floats, faster on the host than the library calls fmaxf and fminf. They return the
/// second argument if the first is NaN.
ESPDIFF_INLINE float larger(float a, float b) { return a > b ? a : b; }
ESPDIFF_INLINE float smaller(float a, float b) { return a < b ? a : b; }

/// False for NaN and infinities. (std::isfinite is not available in device code.)
ESPDIFF_INLINE bool is_finite(float x) { return x - x == 0.0F; }

/// Atomically adds 1 to a counter and returns its previous value. Integers only, because their sum does not depend on
/// the order.
ESPDIFF_INLINE std::uint32_t atomic_increment(std::uint32_t* counter) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(counter, 1U);
#else
  return __atomic_fetch_add(counter, 1U, __ATOMIC_RELAXED);
#endif
}

/// Atomic minimum; returns whether *value was lowered. T is a 32- or 64-bit unsigned integer.
template <typename T>
ESPDIFF_INLINE bool atomic_minimum(T* value, T candidate) {
#if defined(__CUDA_ARCH__)
  using Native = std::conditional_t<sizeof(T) == 8, unsigned long long, unsigned int>;
  return atomicMin(reinterpret_cast<Native*>(value), static_cast<Native>(candidate)) > candidate;
#else
  T current = __atomic_load_n(value, __ATOMIC_RELAXED);
  while (candidate < current) {
    if (__atomic_compare_exchange_n(value, &current, candidate, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) return true;
  }
  return false;
#endif
}

ESPDIFF_INLINE std::uint32_t atomic_load(const std::uint32_t* value) {
#if defined(__CUDA_ARCH__)
  return *reinterpret_cast<const volatile std::uint32_t*>(value);
#else
  return __atomic_load_n(value, __ATOMIC_RELAXED);
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
