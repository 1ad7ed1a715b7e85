// subdivide.h: splits the edges that a mapping has stretched, on both of its meshes.
#pragma once

#include "cuda/surface/mesh/mesh.h"
#include "engine/surface_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::subdivide().
SubdivisionResult subdivide(const SurfaceMesh& source, const SurfaceMesh& mapped, float max_edge_A);

}  // namespace espdiff::ESPDIFF_BACKEND
