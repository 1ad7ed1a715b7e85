// carry_rigidly.h: carries a surface by rigid motions of atoms.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::carry_rigidly().
std::shared_ptr<SurfaceMesh> carry_rigidly(const SurfaceMesh& mesh, const AtomCells& atoms,
                                           const std::vector<std::int32_t>& domains,
                                           const std::vector<RigidTransform>& motions);

}  // namespace espdiff::ESPDIFF_BACKEND
