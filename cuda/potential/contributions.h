// contributions.h: what each charge adds to readings of the potential that it is part of (see Engine::contributions).
#pragma once

#include <vector>

#include "base/progress.h"
#include "cuda/potential/pme.h"
#include "cuda/surface/mesh.h"
#include "cuda/surface/sample.h"

namespace espdiff::ESPDIFF_BACKEND {

/// @param pme the engine's, for its plans and workspace
std::vector<std::vector<double>> contributions(const MapGrid& map, const SurfaceMesh& mesh,
                                               const std::vector<std::vector<double>>& weights, PmeSolver& pme,
                                               const Progress& progress);

/// Those of poisson_boltzmann(), all with the same coefficients.
std::vector<std::vector<double>> pb_contributions(const MapGrid& map, const std::vector<WeightedPlaces>& readings,
                                                  const Progress& progress);

}  // namespace espdiff::ESPDIFF_BACKEND
