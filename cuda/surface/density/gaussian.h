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

/// e^x for -80 <= x <= 0, relative error below 2e-7. No branches and no library call, so loops over it vectorize.
/// Computes 2^f on [-1/2, 1/2] by the Taylor series of e^(f ln 2) to order 6 (remainder below 1.3e-7 relative).
ESPDIFF_INLINE float exp_of_negative(float x) {
  const float t = x * 1.44269504F;
  constexpr float kRound = 12582912.0F;  // 1.5 * 2^23: adding it puts the rounded integer into the low bits
  const float rounded = t + kRound;
  const float f = t - (rounded - kRound);
  float p = 1.5403530e-4F;
  p = p * f + 1.3333558e-3F;
  p = p * f + 9.6181291e-3F;
  p = p * f + 5.5504109e-2F;
  p = p * f + 2.4022651e-1F;
  p = p * f + 6.9314718e-1F;
  p = p * f + 1.0F;
  std::uint32_t bits;
  std::memcpy(&bits, &rounded, sizeof bits);
  const std::uint32_t scale_bits = (bits + 127U) << 23;  // the low bits hold the integer; the rest is shifted out
  float scale;
  std::memcpy(&scale, &scale_bits, sizeof scale);
  return p * scale;
}

}  // namespace espdiff::ESPDIFF_BACKEND
