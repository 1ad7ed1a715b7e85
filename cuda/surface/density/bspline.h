// bspline.h: cardinal B-splines, which spread charges over a grid and interpolate between grid points.
#pragma once

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

constexpr int kLeastSplineOrder = 4, kMostSplineOrder = 8;

/// Number of weights stored per axis: a full vector, so that loops have constant length.
template <int Order>
constexpr int kStoredWeights = Order <= 4 ? 4 : 8;

/// Position of a spline on a periodic axis. Point u (in grid steps, 0 <= u < size) touches the grid points base, base +
/// 1, ... base + order - 1 (modulo size).
struct SplinePlace {
  int base;
  double part;  ///< 0 to 1
};

ESPDIFF_INLINE SplinePlace spline_place(double u, int order, int size) {
  // Shifts the lowest touched point to the whole number below; valid for even and odd orders.
  double shifted = u + 1.0 - 0.5 * static_cast<double>(order);
  if (shifted < 0) shifted += static_cast<double>(size);
  int base = static_cast<int>(shifted);
  const double part = shifted - static_cast<double>(base);
  if (base >= size) base -= size;
  return {base, part};
}

/// u wrapped into [0, size).
ESPDIFF_INLINE double wrapped(double u, int size) {
  const double n = static_cast<double>(size);
  const double inside = u - n * floor(u / n);
  return inside >= n || inside < 0 ? 0.0 : inside;
}

/// Raises the order from N - 1 to `Order`, in place; unrolled by templates because compilers do not.
template <int N, int Order, typename T>
ESPDIFF_INLINE void raise_order(T part, T* m) {
  if constexpr (N <= Order) {
    constexpr T kScale = T(1) / static_cast<T>(N - 1);
    m[N - 1] = kScale * (T(1) - part) * m[N - 2];
    for (int k = N - 2; k > 0; --k) {
      m[k] = kScale * ((part + static_cast<T>(k)) * m[k] + (static_cast<T>(N - k) - part) * m[k - 1]);
    }
    m[0] = kScale * part * m[0];
    raise_order<N + 1, Order>(part, m);
  }
}

/// Weights of the points that a centred B-spline touches: weight[j] = M(part + order - 1 - j), with the recursion
/// M_n(x) = (x M_{n-1}(x) + (n - x) M_{n-1}(x - 1)) / (n - 1) (Essmann et al., J. Chem. Phys. 103, 8577 (1995), eq.
/// 4.1). They sum to 1. Entries from `Order` on are zero.
template <int Order, typename T>
ESPDIFF_INLINE void spline_weights(T part, T* weight) {
  // During the recursion, ascending in the argument: m[k] = M_n(part + k).
  T m[Order] = {};
  m[0] = part;
  m[1] = T(1) - part;
  raise_order<3, Order>(part, m);
  for (int j = 0; j < Order; ++j) weight[j] = m[Order - 1 - j];
  for (int j = Order; j < kStoredWeights<Order>; ++j) weight[j] = T(0);
}

/// Calls body with the order as a compile-time constant: body(std::integral_constant<int, order>()).
template <typename Body>
void with_spline_order(int order, Body body) {
  switch (order) {
    case 4: body(std::integral_constant<int, 4>()); break;
    case 5: body(std::integral_constant<int, 5>()); break;
    case 6: body(std::integral_constant<int, 6>()); break;
    case 7: body(std::integral_constant<int, 7>()); break;
    default: body(std::integral_constant<int, 8>()); break;
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
