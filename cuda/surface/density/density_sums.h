// density_sums.h: the sums over atoms that make a DensitySample, for one point or for lanes of points.
#pragma once

#include "cuda/surface/density/density_at_points.h"
#include "cuda/surface/density/point_sums.h"

namespace espdiff::ESPDIFF_BACKEND {

/// `Number` is float, or a vector of lanes.
template <typename Number>
struct DensitySums {
  Number value{}, gx{}, gy{}, gz{};
};

template <typename Number>
ESPDIFF_INLINE void add_atom(DensitySums<Number>& sum, float exponent, const Number& dx, const Number& dy,
                             const Number& dz, const Number& gaussian) {
  const Number slope = exponent * gaussian;
  sum.value += gaussian;
  sum.gx += slope * dx;
  sum.gy += slope * dy;
  sum.gz += slope * dz;
}

/// The density at one point.
ESPDIFF_INLINE DensitySample density_at(const AtomCellsView& cells, Vec3f p) {
  DensitySums<float> sum;
  sum_at_point(cells, p,
               [&](std::uint32_t, float k, float dx, float dy, float dz, float, float gaussian)
                   ESPDIFF_INLINE_LAMBDA { add_atom(sum, k, dx, dy, dz, gaussian); });
  return {sum.value, 2.0F * Vec3f{sum.gx, sum.gy, sum.gz}};
}

}  // namespace espdiff::ESPDIFF_BACKEND
