// marching_cubes_peer.h: VTK's isosurfaces of the same density grid, as a reference for our triangles and times.
#pragma once

#include <cstddef>

#include "base/types.h"

namespace espdiff_bench {

/// One run of a VTK filter on one thread: triangles without normals or gradients, vertices merged.
struct PeerSurface {
  std::size_t n_triangles = 0, n_vertices = 0;
  double ms = 0;  ///< the filter alone; median of several runs
};

PeerSurface vtk_marching_cubes(const espdiff::Grid& density, float isovalue);
PeerSurface vtk_flying_edges(const espdiff::Grid& density, float isovalue);

}  // namespace espdiff_bench
