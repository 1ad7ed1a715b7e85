// uncovered_surface.h: the part of the target's surface that nothing was mapped to, for drawings.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Uncovered triangles of the target's surface and the triangles around them, so that their border can be smoothed.
struct UncoveredSurface {
  std::vector<Vec3d> positions;  ///< [vertex] in the target's own frame
  std::vector<Vec3f> normals;    ///< [vertex] outward, the target's frame
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> uncovered;  ///< [triangle] 0 around the uncovered part
};

/// @param target    its surface in the common frame, with normals
/// @param beyond    [triangle] nonzero where it is farther than kMatchLimit_A from the mapped surface
/// @param to_target common frame -> the target's own frame
UncoveredSurface uncovered_surface(const Mesh& target, const std::vector<float>& beyond,
                                   const RigidTransform& to_target);

}  // namespace espdiff
