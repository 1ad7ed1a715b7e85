// gaussian.h: a vectorizable exponential for Gaussians with the same bits on every back end.
#pragma once

#include <cstdint>
#include <cstring>

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Gaussians are truncated at this many standard deviations. For a protein (about 0.1 atoms per A^3, s up to 2.3 A) the
/// truncation error of the density is below 1e-3; see the test "density truncation".
constexpr float kCutoffInWidths = 4.5F;
/// The exponent at the cutoff: -4.5^2 / 2.
constexpr float kCutoffExponent = -0.5F * kCutoffInWidths * kCutoffInWidths;

/// The polynomial of degree 5 with p(0) = 1 whose largest relative distance from 2^f on [-1/2, 1/2] is the least
/// possible, 9.2e-8. Number is float, or a vector of lanes.
template <typename Number>
ESPDIFF_INLINE Number power_of_two(const Number& f) {
  Number p = 1.32647291e-3F * f + 9.67151264e-3F;
  p = p * f + 5.55073374e-2F;
  p = p * f + 2.40222421e-1F;
  p = p * f + 6.93146978e-1F;
  return p * f + 1.0F;
}

/// e^x for -80 <= x <= 0, relative error below 2e-7 near 0; far from it that of x log2(e) in a float, 4e-6 at -80. No
/// branches and no library call, so loops over it vectorize.
ESPDIFF_INLINE float exp_of_negative(float x) {
  const float t = x * 1.44269504F;
  constexpr float kRound = 12582912.0F;  // 1.5 * 2^23: adding it puts the rounded integer into the low bits
  const float rounded = t + kRound;
  const float f = t - (rounded - kRound);
  std::uint32_t bits;
  std::memcpy(&bits, &rounded, sizeof bits);
  const std::uint32_t scale_bits = (bits + 127U) << 23;  // the low bits hold the integer; the rest is shifted out
  float scale;
  std::memcpy(&scale, &scale_bits, sizeof scale);
  return power_of_two(f) * scale;
}

}  // namespace espdiff::ESPDIFF_BACKEND
