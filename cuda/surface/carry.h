// carry.h: carries points by a mapping known at a mesh's vertices.
#pragma once

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::carry().
std::shared_ptr<SurfaceMesh> carry(const SurfaceMesh& points, const SurfaceMesh& surface, const SurfaceMesh& image,
                                   float max_distance_A);

}  // namespace espdiff::ESPDIFF_BACKEND
