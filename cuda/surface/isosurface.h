// isosurface.h: marching tetrahedra: the closed surface where a density on a lattice passes an isovalue.
#pragma once

#include "cuda/surface/density/grid.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Inside means density > isovalue; normals point outward, to lower density. Vertices are interpolated linearly along
/// lattice edges and keep a thousandth of the edge from lattice points, so that no triangle degenerates to a point.
/// @throws InputError if the isovalue is not positive (the density is zero far out), GeometryError if no lattice point
/// is inside, MemoryError beyond 2^32 vertices
std::shared_ptr<SurfaceMesh> isosurface(const DensityGrid& density, float isovalue);

}  // namespace espdiff::ESPDIFF_BACKEND
