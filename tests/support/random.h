// random.h: reproducible random numbers and motions of the tests.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/types.h"

namespace espdiff_test {

using espdiff::Vec3d;
using espdiff::Vec3f;

constexpr double kPi = 3.14159265358979323846;

/// Reproducible random numbers: Knuth's MMIX generator, upper bits.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) { bits(); }

  std::uint32_t bits() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::uint32_t>(state_ >> 33);
  }
  /// In [low, high).
  double uniform(double low = 0, double high = 1) { return low + (high - low) * (bits() / 2147483648.0); }
  std::size_t below(std::size_t n) { return bits() % n; }
  Vec3d in_box(double half_side) {
    const double x = uniform(-half_side, half_side), y = uniform(-half_side, half_side);
    return {x, y, uniform(-half_side, half_side)};
  }
  Vec3d direction() {
    for (;;) {
      const Vec3d v = in_box(1);
      const double length = norm(v);
      if (length > 0.1 && length < 1) return (1 / length) * v;
    }
  }

 private:
  std::uint64_t state_;
};

/// Rotation by `angle` about `axis` (a unit vector), then translation.
inline espdiff::RigidTransform rigid(Vec3d axis, double angle, Vec3d translation) {
  espdiff::RigidTransform t;
  const double c = std::cos(angle), s = std::sin(angle);
  for (int column = 0; column < 3; ++column) {
    Vec3d e{};
    e[column] = 1;
    const Vec3d r = c * e + s * cross(axis, e) + ((1 - c) * dot(axis, e)) * axis;  // Rodrigues
    for (int row = 0; row < 3; ++row) t.rotation[3 * row + column] = r[row];
  }
  t.translation = translation;
  return t;
}

inline espdiff::RigidTransform random_rigid(Random& random, double shift) {
  const Vec3d axis = random.direction();
  const double angle = random.uniform(0.3, 3.0);
  return rigid(axis, angle, random.in_box(shift));
}

}  // namespace espdiff_test
