// metrics.h: area-weighted differences of two potentials.
#pragma once

#include "cuda/surface/mesh/mesh.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::compare(). `excluded` and `path_length` may be null.
Metrics compare_potentials(const SurfaceMesh& source, const SurfaceMesh& mapped, const Scalars& source_potential,
                           const Scalars& target_potential, const Scalars* excluded, const Scalars* path_length);

/// [vertex] |a - b|, Angstrom.
std::shared_ptr<Scalars> displacement(const SurfaceMesh& a, const SurfaceMesh& b);

double surface_area(const SurfaceMesh& mesh);

}  // namespace espdiff::ESPDIFF_BACKEND
