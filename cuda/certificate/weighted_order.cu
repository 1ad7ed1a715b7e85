// weighted_order.cu: sorts values and weights as the bits of one integer, which takes one pass per byte.
#include "cuda/certificate/weighted_order.h"

#include <thrust/sort.h>

#include <cstdint>
#include <cstring>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr std::uint32_t kSign = 0x80000000U;

/// Integers in the order of the floats: those of negative floats are reversed and come first.
ESPDIFF_INLINE std::uint32_t ordered_bits(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

float from_ordered_bits(std::uint32_t bits) {
  bits = (bits & kSign) != 0 ? bits & ~kSign : ~bits;
  float x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

}  // namespace

std::vector<std::pair<float, float>> in_ascending_order(const Buffer<float>& values, const Buffer<float>& weights) {
  const std::size_t n = values.size();
  Buffer<std::uint64_t> keys(n);
  std::uint64_t* const key = raw(keys);
  const float *const value = raw(values), *const weight = raw(weights);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    key[i] = static_cast<std::uint64_t>(ordered_bits(value[i])) << 32U | ordered_bits(weight[i]);
  });
  thrust::sort(on_device(), keys.begin(), keys.end());
  std::vector<std::pair<float, float>> sorted;
  sorted.reserve(n);
  for (const std::uint64_t both : to_host(keys))
    sorted.emplace_back(from_ordered_bits(static_cast<std::uint32_t>(both >> 32U)),
                        from_ordered_bits(static_cast<std::uint32_t>(both)));
  return sorted;
}

}  // namespace espdiff::ESPDIFF_BACKEND
