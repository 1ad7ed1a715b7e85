// poisson_boltzmann.h: the potential of charges in a solute, in a solvent with ions (see Engine::poisson_boltzmann).
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "cuda/surface/sample.h"
#include "engine/poisson_boltzmann.h"

namespace espdiff::ESPDIFF_BACKEND {

std::shared_ptr<MapGrid> poisson_boltzmann(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                                           const std::vector<float>& charges, const Lattice& lattice,
                                           const PoissonBoltzmannOptions& options, const RigidTransform& to_map,
                                           const MapGrid* start, const Progress& progress,
                                           PoissonBoltzmannReport* report);

}  // namespace espdiff::ESPDIFF_BACKEND
