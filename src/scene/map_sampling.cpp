// map_sampling.cpp: the inverse of a lattice, and trilinear interpolation.
#include "scene/map_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace espdiff {

LatticeIndex::LatticeIndex(const Lattice& lattice, const std::string& name) : origin_(lattice.origin) {
  const auto& [a, b, c] = lattice.step;
  const double volume = dot(a, cross(b, c));
  if (!(std::abs(volume) > 1e-9 * norm(a) * norm(b) * norm(c))) {
    throw InputError(name + ": the axes of the map lie in a plane; compute the map again");
  }
  rows_[0] = (1 / volume) * cross(b, c);
  rows_[1] = (1 / volume) * cross(c, a);
  rows_[2] = (1 / volume) * cross(a, b);
}

float sample_at(const Grid& map, Vec3d index) {
  constexpr double kSlack = 1e-4;
  std::size_t low[3];
  double w[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int size = map.lattice.size[static_cast<std::size_t>(axis)];
    if (!(index[axis] >= -kSlack && index[axis] <= size - 1 + kSlack) || size < 2)
      return std::numeric_limits<float>::quiet_NaN();
    const double floor = std::clamp(std::floor(index[axis]), 0.0, size - 2.0);
    low[axis] = static_cast<std::size_t>(floor);
    w[axis] = std::clamp(index[axis] - floor, 0.0, 1.0);
  }
  const auto nx = static_cast<std::size_t>(map.lattice.size[0]), ny = static_cast<std::size_t>(map.lattice.size[1]);
  double value = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t i = corner & 1, j = (corner >> 1) & 1, k = corner >> 2;
    const double weight = (i ? w[0] : 1 - w[0]) * (j ? w[1] : 1 - w[1]) * (k ? w[2] : 1 - w[2]);
    value += weight * static_cast<double>(map.values[low[0] + i + nx * (low[1] + j + ny * (low[2] + k))]);
  }
  return static_cast<float>(value);
}

}  // namespace espdiff
