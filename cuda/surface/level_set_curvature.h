// level_set_curvature.h: mean curvature of the analytic isosurface at the vertices of a mesh on it.
#pragma once

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::level_set_curvature().
Buffer<float> level_set_curvature(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue);

}  // namespace espdiff::ESPDIFF_BACKEND
