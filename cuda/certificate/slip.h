// slip.h: how far mapped points are from where the atoms at their source carried them.
#pragma once

#include <vector>

#include "cuda/surface/mesh/mesh.h"

namespace espdiff {
struct MovingAtom;
}

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::slip().
std::vector<float> slip(const SurfaceMesh& source, const SurfaceMesh& mapped, const SurfaceMesh& target,
                        const std::vector<MovingAtom>& atoms);

/// The general form, vertex by vertex; gives the same bits.
std::vector<float> slip_point_by_point(const SurfaceMesh& source, const SurfaceMesh& mapped, const SurfaceMesh& target,
                                       const std::vector<MovingAtom>& atoms);

}  // namespace espdiff::ESPDIFF_BACKEND
