// potential_sums.h: sums over the area of two potentials at corresponding points, and the metrics that follow from
// them.
#pragma once

#include <cmath>
#include <limits>

#include "base/vector.h"
#include "engine/certificate_stage.h"

namespace espdiff {

/// Sums over points, each weighted by its area: of potentials a (of the source) and b (of the target).
struct PotentialSums {
  double area_A2 = 0;
  double abs_difference = 0, squared_difference = 0, difference = 0;  ///< of b - a
  double sign_change = 0;  ///< area where one is positive, the other negative
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;

  ESPDIFF_HD PotentialSums& operator+=(const PotentialSums& o) {
    area_A2 += o.area_A2;
    abs_difference += o.abs_difference;
    squared_difference += o.squared_difference;
    difference += o.difference;
    sign_change += o.sign_change;
    a += o.a;
    b += o.b;
    aa += o.aa;
    bb += o.bb;
    ab += o.ab;
    return *this;
  }

  /// All metrics of two potentials. NaN without area, and what needs the mapping itself (displacement, path length).
  Metrics metrics() const {
    Metrics m;
    m.area_A2 = area_A2;
    m.mean_abs_difference = abs_difference / area_A2;  // 0/0 is NaN
    m.rms_difference = std::sqrt(squared_difference / area_A2);
    m.mean_signed_difference = difference / area_A2;
    m.sign_change_area_fraction = sign_change / area_A2;
    m.hodgkin_index = 2 * ab / (aa + bb);
    m.carbo_index = ab / std::sqrt(aa * bb);
    m.correlation = correlation();
    m.mean_displacement_A = m.mean_path_length_A = std::numeric_limits<double>::quiet_NaN();
    return m;
  }

  /// Pearson's correlation; NaN where one side is constant. A spread that rounding could have made counts as none.
  double correlation() const {
    const double of_a = aa - a * a / area_A2, of_b = bb - b * b / area_A2;
    constexpr double kRounding = 1e-12;
    if (!(of_a > kRounding * aa) || !(of_b > kRounding * bb)) return std::numeric_limits<double>::quiet_NaN();
    return (ab - a * b / area_A2) / std::sqrt(of_a * of_b);
  }
};

}  // namespace espdiff
