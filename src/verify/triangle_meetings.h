// triangle_meetings.h: counts pairs of triangles that cross, by VTK's locator and signs of volumes in double precision.
#pragma once

#include <cstddef>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Pairs of triangles that meet elsewhere than in common vertices and edges; a triangle without area counts as a pair.
/// Signs are not exact: triangles that only touch may count or not. Where thousands of triangles lie on each other, as
/// in a damaged file, the count ends early, in the thousands.
std::size_t count_meetings(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles);

}  // namespace espdiff
