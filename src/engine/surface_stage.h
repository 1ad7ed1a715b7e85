// surface_stage.h: results of the stages that make and edit surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/handles.h"

namespace espdiff {

/// A connected component of a closed mesh.
struct ComponentSummary {
  std::uint32_t n_vertices = 0;
  std::uint32_t n_triangles = 0;
  double area_A2 = 0;
  double volume_A3 = 0;  ///< signed: negative for a cavity, whose normals point into the void
};

/// Result of subdivide(): both meshes with the same edges split. Old vertices keep their numbers and positions.
struct SubdivisionResult {
  MeshPtr source, mapped;
  std::vector<std::array<std::uint32_t, 2>> ends;  ///< [new vertex] the ends of the edge whose midpoint it is
};

}  // namespace espdiff
