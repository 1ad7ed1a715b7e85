// field_lines.h: field lines of a potential map.
#pragma once

#include <vector>

#include "base/types.h"

namespace espdiff {

struct PlacedMap;

/// Field lines (along -grad of the potential, in both directions) from points on the surface, outside of it. They start
/// at the vertices with the strongest field, at least 4 A apart. Fourth-order Runge-Kutta steps of 0.25 A in the
/// trilinear map's gradient by central differences. A line ends at the map's border, inside the surface, where the
/// field vanishes, or after 60 A.
/// @param positions [vertex]; @param normals [vertex] unit, outward
std::vector<std::vector<Vec3d>> trace_field_lines(const PlacedMap& map, const std::vector<Vec3d>& positions,
                                                  const std::vector<Vec3f>& normals, int n_lines);

}  // namespace espdiff
