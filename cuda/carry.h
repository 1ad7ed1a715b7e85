// carry.h: points taken along by a mapping that is known at a mesh's vertices.
#pragma once

#include "mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::carry().
std::shared_ptr<SurfaceMesh> carry(const SurfaceMesh& points, const SurfaceMesh& surface, const SurfaceMesh& image,
                                   float max_distance_A);

}  // namespace espdiff::ESPDIFF_BACKEND
