// fans.h: proves for most vertices at once that no two triangles around them intersect.
//
// Nearly all pairs of triangles with overlapping boxes share a vertex. If the triangles around a vertex, its fan, seen
// along a coordinate axis all turn the same way and together go around once, their views overlap nowhere, and neither
// do the triangles. All signs are exact, so the answer is that of testing each pair.
#pragma once

#include "cuda/certificate/triangle_pairs.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Whether a point lies below another in a view, or beside it to the left.
ESPDIFF_INLINE bool lies_below(Vec2f p, Vec2f centre) { return p.y < centre.y || (p.y == centre.y && p.x < centre.x); }

/// The axis along which the triangles around a vertex show the most area.
ESPDIFF_INLINE int axis_of_fan(const TopologyView& mesh, const Vec4f* x, std::uint32_t v) {
  Vec3f sum{};
  for (std::uint32_t i = mesh.first[v]; i < mesh.first[v + 1]; ++i)
    sum += twice_area_vector(x, mesh.triangles[mesh.incident[i]]);
  const float along_x = fabsf(sum.x), along_y = fabsf(sum.y), along_z = fabsf(sum.z);
  return along_x >= along_y && along_x >= along_z ? 0 : along_y >= along_z ? 1 : 2;
}

/// Whether the triangles around the vertex close to a fan that an axis shows without overlap: then no two of them
/// intersect. False says nothing.
ESPDIFF_HD inline bool fan_has_no_intersection(const TopologyView& mesh, const Vec4f* x, std::uint32_t v) {
  constexpr std::uint32_t kMost = 16;
  const std::uint32_t begin = mesh.first[v], n = mesh.first[v + 1] - begin;
  if (n == 0 || n > kMost) return false;
  const int axis = axis_of_fan(mesh, x, v);
  const Vec2f centre = seen_along(axis, x[v].xyz());
  std::uint32_t last[kMost];  // of the three corners, in order from v
  int side = 0, n_turns = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Corners c = mesh.triangles[mesh.incident[begin + i]];
    last[i] = c.v[0] == v ? c.v[2] : c.v[1] == v ? c.v[0] : c.v[1];
    const Vec2f from = seen_along(axis, x[mesh.neighbour[begin + i]].xyz()), to = seen_along(axis, x[last[i]].xyz());
    const int turned = turn(centre, from, to);
    if (turned == 0 || (i > 0 && turned != side)) return false;
    side = turned;
    // Each time around, one triangle goes up through the height of the centre.
    if (lies_below(from, centre) && !lies_below(to, centre)) ++n_turns;
  }
  if (n_turns != 1) return false;
  for (std::uint32_t i = 0; i < n; ++i) {
    bool goes_on = false;
    for (std::uint32_t k = 0; k < n; ++k) goes_on = goes_on || last[k] == mesh.neighbour[begin + i];
    if (!goes_on) return false;
  }
  return true;
}

}  // namespace espdiff::ESPDIFF_BACKEND
