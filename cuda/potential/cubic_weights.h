// cubic_weights.h: cubic Lagrange interpolation.
#pragma once

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Weights of four points in a row; t runs from 0 to 1 between the middle two.
template <typename T>
ESPDIFF_INLINE void cubic_weights(T t, T (&w)[4]) {
  w[0] = -t * (t - 1) * (t - 2) / 6;
  w[1] = (t + 1) * (t - 1) * (t - 2) / 2;
  w[2] = -(t + 1) * t * (t - 2) / 2;
  w[3] = (t + 1) * t * (t - 1) / 6;
}

}  // namespace espdiff::ESPDIFF_BACKEND
