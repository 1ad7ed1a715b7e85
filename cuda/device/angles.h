// angles.h: inverse trigonometric functions without branches and library calls, with the same bits on every back end.
//
// Polynomials of Abramowitz and Stegun, Handbook of Mathematical Functions (1964), 4.4.46 and 4.4.49: both err by less
// than 2e-8, and single precision by about 2e-7.
#pragma once

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The angle in [0, pi] of a cosine in [-1, 1].
ESPDIFF_INLINE float angle_of_cosine(float x) {
  const float a = fabsf(x);
  float p = -0.0012624911F;
  p = p * a + 0.0066700901F;
  p = p * a - 0.0170881256F;
  p = p * a + 0.0308918810F;
  p = p * a - 0.0501743046F;
  p = p * a + 0.0889789874F;
  p = p * a - 0.2145988016F;
  p = p * a + 1.5707963050F;
  const float of_size = sqrtf(1.0F - a) * p;
  return x < 0.0F ? 3.14159265F - of_size : of_size;
}

/// The angle in [-pi, pi] of the direction (x, y) from the x axis; 0 where both are 0.
ESPDIFF_INLINE float angle_of_direction(float y, float x) {
  const float ax = fabsf(x), ay = fabsf(y), most = ax > ay ? ax : ay, least = ax > ay ? ay : ax;
  const float t = most > 0.0F ? least / most : 0.0F, s = t * t;
  float p = 0.0028662257F;
  p = p * s - 0.0161657367F;
  p = p * s + 0.0429096138F;
  p = p * s - 0.0752896400F;
  p = p * s + 0.1065626393F;
  p = p * s - 0.1420889944F;
  p = p * s + 0.1999355085F;
  p = p * s - 0.3333314528F;
  p = p * s + 1.0F;
  float angle = t * p;
  angle = ay > ax ? 1.57079633F - angle : angle;
  angle = x < 0.0F ? 3.14159265F - angle : angle;
  return y < 0.0F ? -angle : angle;
}

}  // namespace espdiff::ESPDIFF_BACKEND
