// carry.h: carries points by a mapping known at a mesh's vertices, or by rigid motions of atoms.
#pragma once

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::carry().
std::shared_ptr<SurfaceMesh> carry(const SurfaceMesh& points, const SurfaceMesh& surface, const SurfaceMesh& image,
                                   float max_distance_A);

/// See Engine::carry_rigidly() (carry_rigidly.cu).
std::shared_ptr<SurfaceMesh> carry_rigidly(const SurfaceMesh& mesh, const AtomCells& atoms,
                                           const std::vector<std::int32_t>& domains,
                                           const std::vector<RigidTransform>& motions);

}  // namespace espdiff::ESPDIFF_BACKEND
