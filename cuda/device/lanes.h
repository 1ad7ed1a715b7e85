// lanes.h: vectors of floats that hold one point to a lane, on the CPU.
#pragma once

#include <cstdint>
#include <cstring>

#include "cuda/device/device.h"

#if !defined(__CUDACC__)

namespace espdiff::ESPDIFF_BACKEND {

/// Vectors of N lanes: numbers, masks (-1 or 0), bits, and words of two lanes.
template <std::size_t N>
struct LaneTypes;
// GCC 12 takes no size of a vector that depends on a parameter here.
template <>
struct LaneTypes<8> {
  using Numbers = float __attribute__((vector_size(32)));
  using Mask = std::int32_t __attribute__((vector_size(32)));
  using Bits = std::uint32_t __attribute__((vector_size(32)));
  using Words = std::uint64_t __attribute__((vector_size(32)));
};
template <>
struct LaneTypes<16> {
  using Numbers = float __attribute__((vector_size(64)));
  using Mask = std::int32_t __attribute__((vector_size(64)));
  using Bits = std::uint32_t __attribute__((vector_size(64)));
  using Words = std::uint64_t __attribute__((vector_size(64)));
};

/// Lanes of a block of points: as many as AVX2's vectors hold, and in a wide block as many as those of AVX-512. Wider
/// ones than the processor's would be taken apart into single lanes by GCC 12 where they are compared.
constexpr std::size_t kBlock = 8, kWideBlock = 16;
using Lanes = LaneTypes<kBlock>::Numbers;
using LaneMask = LaneTypes<kBlock>::Mask;

template <typename Vector>
using TypesOf = LaneTypes<sizeof(Vector) / sizeof(float)>;
template <typename Numbers>
using MaskOf = typename TypesOf<Numbers>::Mask;

/// `a` where the mask is set, otherwise `b`. The mask should be one comparison: GCC 12 takes a combination of
/// comparisons apart into single lanes.
template <typename Mask, typename Vector>
ESPDIFF_INLINE Vector chosen(const Mask& mask, const Vector& a, const Vector& b) {
  return (Vector)(((Mask)a & mask) | ((Mask)b & ~mask));
}
/// In this form GCC takes one instruction for it.
template <typename Vector>
ESPDIFF_INLINE Vector smaller_lanes(const Vector& a, const Vector& b) {
  return a < b ? a : b;
}
template <typename Vector>
ESPDIFF_INLINE Vector larger_lanes(const Vector& a, const Vector& b) {
  return a > b ? a : b;
}

/// All pairs of lanes in one word by "or". Halves are joined first, because taking out words is slow.
template <typename Mask>
ESPDIFF_INLINE std::uint64_t joined_words(const Mask& mask) {
  using Words = typename TypesOf<Mask>::Words;
  const Words all = (Words)mask;
  if constexpr (sizeof(Mask) == kBlock * sizeof(float)) {
    const auto half = __builtin_shufflevector(all, all, 0, 1) | __builtin_shufflevector(all, all, 2, 3);
    return half[0] | half[1];
  } else {
    const auto half = __builtin_shufflevector(all, all, 0, 1, 2, 3) | __builtin_shufflevector(all, all, 4, 5, 6, 7);
    const auto quarter = __builtin_shufflevector(half, half, 0, 1) | __builtin_shufflevector(half, half, 2, 3);
    return quarter[0] | quarter[1];
  }
}

template <typename Mask>
ESPDIFF_INLINE bool any_lane(const Mask& mask) {
  return joined_words(mask) != 0;
}

/// The lanes of a mask as bits.
template <typename Mask>
ESPDIFF_INLINE std::uint32_t bits_of(const Mask& mask) {
  Mask bit;
  for (std::size_t lane = 0; lane < sizeof(Mask) / sizeof(float); ++lane) bit[lane] = 1 << lane;
  const std::uint64_t words = joined_words(mask & bit);
  return static_cast<std::uint32_t>(words | words >> 32U);
}

template <typename Numbers>
ESPDIFF_INLINE void load_lanes(const float* values, Numbers& lanes) {
  std::memcpy(&lanes, values, sizeof lanes);
}

/// [bits] the places of the ones among eight bits, in ascending order.
struct OnesOfEight {
  std::uint8_t places[256][8];
};
constexpr OnesOfEight ones_of_eight() {
  OnesOfEight table{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    std::size_t n = 0;
    for (unsigned place = 0; place < 8; ++place) {
      if ((bits >> place & 1U) != 0) table.places[bits][n++] = static_cast<std::uint8_t>(place);
    }
  }
  return table;
}
inline constexpr OnesOfEight kOnesOfEight = ones_of_eight();

/// Lists which bits are set, without a branch that would be guessed wrong for each word: eight places are written at
/// once, and those beyond the count are overwritten.
template <std::size_t Most>
struct PlacesOfOnes {
  std::size_t n = 0;
  std::uint16_t places[Most + kBlock];

  /// @param bits of N places, the first of which is `first`
  template <std::size_t N>
  ESPDIFF_INLINE void append(std::uint32_t bits, std::size_t first) {
    for (std::size_t part = 0; part < N; part += kBlock) {
      const std::uint32_t eight = bits >> part & 255U;
      for (std::size_t k = 0; k < kBlock; ++k)
        places[n + k] = static_cast<std::uint16_t>(first + part + kOnesOfEight.places[eight][k]);
      n += static_cast<std::size_t>(__builtin_popcount(eight));
    }
  }
};

}  // namespace espdiff::ESPDIFF_BACKEND

#endif
