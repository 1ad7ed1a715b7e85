// device.h: the back end's namespace, its buffers, and the few parallel forms that the stages are written in.
//
// Every .cu is compiled twice: with ESPDIFF_BACKEND=cpu_backend by g++ (Thrust's OpenMP device system) and with
// ESPDIFF_BACKEND=cuda_backend by nvcc. The namespace keeps the two sets of inline functions apart.
#pragma once

#include <thrust/copy.h>
#include <thrust/device_vector.h>
#include <thrust/execution_policy.h>
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/scan.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "base/vector.h"

// Compiles a hot host function for several instruction sets and picks one at load time. Without contraction all give
// the same bits, so the choice changes speed alone.
#if defined(__GNUC__) && !defined(__CUDACC__) && defined(__x86_64__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define ESPDIFF_MULTIVERSION __attribute__((target_clones("default", "arch=haswell", "arch=skylake-avx512")))
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

// Each target wraps its Thrust in a namespace of its own (THRUST_CUB_WRAPPED_NAMESPACE).
namespace thrust = THRUST_NS_QUALIFIER;

/// An array on the device.
template <typename T>
using Buffer = thrust::device_vector<T>;

template <typename T>
T* raw(Buffer<T>& buffer) {
  return thrust::raw_pointer_cast(buffer.data());
}
template <typename T>
const T* raw(const Buffer<T>& buffer) {
  return thrust::raw_pointer_cast(buffer.data());
}

template <typename T>
Buffer<T> to_device(const std::vector<T>& host) {
  return Buffer<T>(host.begin(), host.end());
}
template <typename T>
std::vector<T> to_host(const Buffer<T>& buffer) {
  std::vector<T> host(buffer.size());
  thrust::copy(buffer.begin(), buffer.end(), host.begin());
  return host;
}

/// Calls body(i) for each i in [0, n) in parallel. Deterministic when no call writes what another reads or writes.
template <typename Body>
void for_each_index(std::size_t n, Body body) {
  if (n == 0) return;
  thrust::for_each_n(thrust::device, thrust::counting_iterator<std::size_t>(0), n, body);
}

constexpr std::size_t kReductionChunk = 2048;

/// Sum of term(i) over [0, n) as a T (with operator+=, value-initialized to zero): chunks of fixed size in order, then
/// the chunks in order, so that the result does not depend on the number of threads.
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

/// Replaces counts by their running sum before each; returns the total.
template <typename T>
T exclusive_scan_in_place(Buffer<T>& counts) {
  if (counts.empty()) return T{};
  const T last = counts.back();
  thrust::exclusive_scan(thrust::device, counts.begin(), counts.end(), counts.begin());
  return static_cast<T>(counts.back() + last);
}

/// The larger, the smaller of two: fmaxf and fminf are calls into a library on the host. Where the first is NaN, the
/// second.
ESPDIFF_INLINE float larger(float a, float b) { return a > b ? a : b; }
ESPDIFF_INLINE float smaller(float a, float b) { return a < b ? a : b; }

/// False for NaN and infinities; std::isfinite is not for device code.
ESPDIFF_INLINE bool is_finite(float x) { return x - x == 0.0F; }

/// Adds to a counter that other threads add to as well; returns its value before. Integers only: their sum has no
/// order.
ESPDIFF_INLINE std::uint32_t atomic_increment(std::uint32_t* counter) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(counter, 1U);
#else
  return __atomic_fetch_add(counter, 1U, __ATOMIC_RELAXED);
#endif
}

/// Lowers *value to candidate if that is smaller; returns whether it did. T is a 32- or 64-bit unsigned integer.
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
