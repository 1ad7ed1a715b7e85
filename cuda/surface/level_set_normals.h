// level_set_normals.h: the normals of the analytic isosurface at the vertices of a mesh that lies on it.
#pragma once

#include "cuda/surface/atom_cells.h"
#include "cuda/surface/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// [vertex] unit, outward: where the density falls fastest. Of a vertex whose density is off the isovalue by more than
/// a tenth of it, or whose direction opposes its triangles', the mean of the triangles' normals (vertex_normals()).
Buffer<Vec4f> level_set_normals(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue);

}  // namespace espdiff::ESPDIFF_BACKEND
