// triangle_areas.h: areas of triangles, and their shares at vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// @param p [vertex] positions. In the square of their unit
template <typename Positions>
double triangle_area(const Positions& p, const Triangle& v) {
  return 0.5 * norm(cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]));
}

/// [vertex] a third of the area of each triangle that counts. @param counts [triangle] called with its index
template <typename Positions, typename Counts>
std::vector<double> corner_areas(const Positions& p, const std::vector<Triangle>& triangles, const Counts& counts) {
  std::vector<double> weight(p.size(), 0.0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!counts(t)) continue;
    const double area = triangle_area(p, triangles[t]);
    for (const std::uint32_t c : triangles[t]) weight[c] += area / 3;
  }
  return weight;
}

}  // namespace espdiff
