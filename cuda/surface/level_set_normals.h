// level_set_normals.h: normals of the analytic isosurface at the vertices of a mesh on it.
#pragma once

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// [vertex] unit outward normal: the direction in which the density falls fastest. If the vertex's density differs from
/// the isovalue by more than a tenth of it, or the direction opposes the triangles', the mean of the triangles' normals
/// instead (vertex_normals()).
Buffer<Vec4f> level_set_normals(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue);

}  // namespace espdiff::ESPDIFF_BACKEND
