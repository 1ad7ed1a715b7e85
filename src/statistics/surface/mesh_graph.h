// mesh_graph.h: neighbours and areas of a mesh's vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// A mesh as statistics need it.
struct MeshGraph {
  std::vector<std::uint32_t> first;       ///< [vertex + 1] of its neighbours in `neighbours`
  std::vector<std::uint32_t> neighbours;  ///< vertices that share an edge, rising
  std::vector<double> area;               ///< [vertex] a third of the area of its triangles

  std::size_t n_vertices() const { return area.size(); }
};

/// @param positions any unit of length; the areas are in its square
MeshGraph make_mesh_graph(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles);

}  // namespace espdiff
