// pmepot_places.h: grid coordinates of charges with the rounding of PMEPot's single precision.
//
// PMEPot's coordinates are off by up to 1e-5 grid steps. That changes the potential of a box of water by 2e-5 of its
// maximum, more than the compatible mode may differ. The rest of its arithmetic matters less.
#pragma once

#include <array>
#include <cmath>

#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Grid coordinates in a cell, each step rounded to float where PMEPot's is.
class PmepotPlaces {
 public:
  PmepotPlaces(const PmeCell& cell, const std::array<int, 3>& size) : size_{size[0], size[1], size[2]} {
    Vec3f edges[3];
    for (std::size_t i = 0; i < 3; ++i) edges[i] = static_cast<Vec3f>(cell.edges[i]);
    origin_ = static_cast<Vec3f>(cell.centre);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3f normal = cross(edges[(i + 1) % 3], edges[(i + 2) % 3]);
      reciprocal_[i] = static_cast<float>(1.0 / static_cast<double>(dot(edges[i], normal))) * normal;
      const double n = size[i];
      origin_ += static_cast<float>(-0.5 * (n - 1.0) / n) * edges[i];
      // Two steps are added before a coordinate is wrapped, and taken off again after.
      shift_[i] = static_cast<float>(kSteps / n);
    }
  }

  /// 0 to size along each axis.
  ESPDIFF_HD Vec3d coordinates(const Vec3d& position) const {
    const Vec3f p = static_cast<Vec3f>(position) - origin_;
    Vec3d u;
    for (int i = 0; i < 3; ++i) {
      const double n = size_[i], part = static_cast<double>(dot(p, reciprocal_[i]) + shift_[i]);
      const float wrapped_float = static_cast<float>(n * (part - floor(part)));
      const double shifted = static_cast<double>(wrapped_float) >= n ? 0.0 : static_cast<double>(wrapped_float);
      u[i] = shifted >= kSteps ? shifted - kSteps : shifted - kSteps + n;
    }
    return u;
  }

 private:
  static constexpr double kSteps = 2;
  int size_[3];
  Vec3f origin_;
  Vec3f reciprocal_[3];
  float shift_[3];
};

}  // namespace espdiff::ESPDIFF_BACKEND
