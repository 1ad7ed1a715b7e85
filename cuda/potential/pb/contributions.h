// contributions.h: what each charge adds to readings of the potential that it is part of (see Engine::contributions).
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "cuda/potential/pme.h"
#include "cuda/surface/sample.h"

namespace espdiff::ESPDIFF_BACKEND {

/// @param pme the engine's, for its plans and workspace
std::vector<std::vector<double>> contributions(const MapGrid& map, const std::vector<PotentialReading>& readings,
                                               const std::vector<ProbeCharge>& probes, PmeSolver& pme,
                                               const Progress& progress);

}  // namespace espdiff::ESPDIFF_BACKEND
