// screw.h: a rigid motion as a rotation about an axis plus a translation, and fractions of it.
#pragma once

#include <cmath>

#include "base/vector.h"

namespace espdiff {

/// x -> through + R (x - through) + shift, with R the rotation by `angle` about `axis`. If it rotates, the shift is
/// along the axis (Chasles), so fractions of the motion commute: apply(apply(x, s), t) = apply(x, s + t). The default
/// is no motion.
struct Screw {
  Vec3d axis{0, 0, 1};  ///< unit
  Vec3d through{};      ///< a point on the axis, Angstrom
  double angle = 0;     ///< radians
  Vec3d shift{};        ///< Angstrom

  /// Rotates a vector by a fraction of the angle (Rodrigues' formula).
  Vec3d turn(Vec3d v, double share) const {
    if (angle == 0) return v;
    const double c = std::cos(share * angle), s = std::sin(share * angle);
    return c * v + s * cross(axis, v) + ((1 - c) * dot(axis, v)) * axis;
  }
  /// Moves a point by a fraction of the motion: 1 for all of it, -1 for its inverse.
  Vec3d apply(Vec3d p, double share) const {
    if (angle == 0) return p + share * shift;
    return through + turn(p - through, share) + share * shift;
  }
  /// d/dshare at a point that the motion has moved to p.
  Vec3d velocity_at(Vec3d p) const { return angle * cross(axis, p - through) + shift; }
};

}  // namespace espdiff
