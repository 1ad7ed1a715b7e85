// screw.h: a rigid motion as a turn about an axis and a shift, and any part of the way.
#pragma once

#include <cmath>

#include "base/vector.h"

namespace espdiff {

/// x -> through + R (x - through) + shift, R the turn by `angle` about `axis`. Where it turns, the shift is along the
/// axis (Chasles): parts of the motion then commute, and apply(apply(x, s), t) = apply(x, s + t). No motion by default.
struct Screw {
  Vec3d axis{0, 0, 1};  ///< unit
  Vec3d through{};      ///< a point on the axis, Angstrom
  double angle = 0;     ///< radians
  Vec3d shift{};        ///< Angstrom

  /// A vector turned by a part of the angle (Rodrigues' formula).
  Vec3d turn(Vec3d v, double share) const {
    if (angle == 0) return v;
    const double c = std::cos(share * angle), s = std::sin(share * angle);
    return c * v + s * cross(axis, v) + ((1 - c) * dot(axis, v)) * axis;
  }
  /// A point after a part of the motion: 1 for all of it, -1 for its inverse.
  Vec3d apply(Vec3d p, double share) const {
    if (angle == 0) return p + share * shift;
    return through + turn(p - through, share) + share * shift;
  }
  /// d/dshare of a point that the motion has brought to p.
  Vec3d velocity_at(Vec3d p) const { return angle * cross(axis, p - through) + shift; }
};

}  // namespace espdiff
