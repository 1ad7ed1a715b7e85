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

#include "base/multiversion.h"
#include "base/vector.h"
#include "cuda/device/buffer.h"
#include "cuda/device/launch.h"

#if defined(__CUDACC__)
#define ESPDIFF_INLINE __host__ __device__ __forceinline__
#define ESPDIFF_INLINE_LAMBDA
#else
#define ESPDIFF_INLINE inline __attribute__((always_inline))
#define ESPDIFF_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace espdiff::ESPDIFF_BACKEND {

#if defined(ESPDIFF_BACKEND_CUDA)
constexpr std::size_t kReductionChunk = 512;  // enough blocks for a large GPU from a surface's 40,000 vertices
#else
constexpr std::size_t kReductionChunk = 2048;
#endif

struct IndexRange {
  std::size_t begin, end;
};

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

/// Sums of term(i) over chunks of kReductionChunk indices of [0, n): [chunk], after one element that is left free.
template <typename T, typename Term>
Buffer<T> chunk_sums(std::size_t n, Term term) {
  const std::size_t n_chunks = (n + kReductionChunk - 1) / kReductionChunk;
  Buffer<T> sums(n_chunks + 1);
  if (n == 0) return sums;
  sum_chunks_kernel<<<static_cast<unsigned>(n_chunks), kReductionThreads, 0, CudaContext::current()->stream()>>>(
      n, term, raw(sums) + 1);
  check_cuda(cudaGetLastError(), "starting a sum");
  return sums;
}

template <typename T, typename Term>
__global__ void __launch_bounds__(kReductionThreads) sum_ranges_kernel(const IndexRange* ranges, Term term, T* sums) {
  const IndexRange range = ranges[blockIdx.x];
  block_sum<T>(range.begin, range.end, term, sums + blockIdx.x);
}

/// [range] the sum of term(i) over each range, in the order of chunk_sums().
template <typename T, typename Term>
Buffer<T> range_sums(const Buffer<IndexRange>& ranges, Term term) {
  Buffer<T> sums(ranges.size());
  if (ranges.empty()) return sums;
  sum_ranges_kernel<<<static_cast<unsigned>(ranges.size()), kReductionThreads, 0, CudaContext::current()->stream()>>>(
      raw(ranges), term, raw(sums));
  check_cuda(cudaGetLastError(), "starting a sum");
  return sums;
}

/// Element 0 is sum_over(n, term), which stays on the device.
template <typename T, typename Term>
Buffer<T> sum_on_device(std::size_t n, Term term) {
  Buffer<T> sums = chunk_sums<T>(n, term);
  sum_partial_kernel<<<1, kReductionThreads, 0, CudaContext::current()->stream()>>>(sums.size() - 1, raw(sums) + 1,
                                                                                    raw(sums));
  check_cuda(cudaGetLastError(), "starting a sum");
  return sums;
}

#else

/// Sums of term(i) over chunks of kReductionChunk indices of [0, n): [chunk], after one element that is left free.
template <typename T, typename Term>
Buffer<T> chunk_sums(std::size_t n, Term term) {
  const std::size_t n_chunks = (n + kReductionChunk - 1) / kReductionChunk;
  Buffer<T> sums(n_chunks + 1);
  T* const of_chunk = raw(sums) + 1;
  for_each_index(n_chunks, [=] ESPDIFF_HD(std::size_t chunk) {
    T sum{};
    const std::size_t end = (chunk + 1) * kReductionChunk < n ? (chunk + 1) * kReductionChunk : n;
    for (std::size_t i = chunk * kReductionChunk; i < end; ++i) sum += term(i);
    of_chunk[chunk] = sum;
  });
  return sums;
}

/// [range] the sum of term(i) over each range, in the order of chunk_sums().
template <typename T, typename Term>
Buffer<T> range_sums(const Buffer<IndexRange>& ranges, Term term) {
  Buffer<T> sums(ranges.size());
  T* const out = raw(sums);
  const IndexRange* const range = raw(ranges);
  for_each_index(ranges.size(), [=] ESPDIFF_HD(std::size_t r) {
    T sum{};
    for (std::size_t i = range[r].begin; i < range[r].end; ++i) sum += term(i);
    out[r] = sum;
  });
  return sums;
}

/// Element 0 is sum_over(n, term), which stays on the device.
template <typename T, typename Term>
Buffer<T> sum_on_device(std::size_t n, Term term) {
  Buffer<T> sums = chunk_sums<T>(n, term);
  T total{};
  for (const T* sum = sums.begin() + 1; sum != sums.end(); ++sum) total += *sum;
  *sums.begin() = total;
  return sums;
}

#endif

/// Sum of term(i) over [0, n) as a T (with operator+=, value-initialized to zero); waits for it. Bitwise reproducible:
/// sums chunks of fixed size, then the chunks, so the result does not depend on the number of threads.
template <typename T, typename Term>
T sum_over(std::size_t n, Term term) {
  return n == 0 ? T{} : sum_on_device<T>(n, term)[0];
}

/// Exclusive prefix sum, in place.
template <typename T>
void running_sum_in_place(Buffer<T>& counts) {
  if (!counts.empty()) thrust::exclusive_scan(on_device(), counts.begin(), counts.end(), counts.begin());
}

/// The total of an exclusive prefix sum in place, read together with other numbers.
template <typename T>
class ScanTotal {
 public:
  /// Computes the prefix sum and adds the total to `reads`, which must wait before get().
  ScanTotal(Buffer<T>& counts, HostReads& reads) {
    if (counts.empty()) return;
    read_element(reads, last_, counts, counts.size() - 1);
    running_sum_in_place(counts);
    read_element(reads, before_last_, counts, counts.size() - 1);
  }
  ScanTotal(const ScanTotal&) = delete;
  ScanTotal& operator=(const ScanTotal&) = delete;
  T get() const { return static_cast<T>(before_last_ + last_); }

 private:
  T last_{}, before_last_{};
};

/// Exclusive prefix sum, in place; waits for the total and returns it.
template <typename T>
T exclusive_scan_in_place(Buffer<T>& counts) {
  HostReads reads;
  ScanTotal<T> total(counts, reads);
  reads.wait();
  return total.get();
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

/// Atomically replaces *value by `desired` if it is `expected`; returns its previous value.
ESPDIFF_INLINE std::uint32_t atomic_compare_exchange(std::uint32_t* value, std::uint32_t expected,
                                                     std::uint32_t desired) {
#if defined(__CUDA_ARCH__)
  return atomicCAS(value, expected, desired);
#else
  __atomic_compare_exchange_n(value, &expected, desired, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
  return expected;
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
