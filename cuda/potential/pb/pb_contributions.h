// pb_contributions.h: what each charge adds to readings of a Poisson-Boltzmann potential.
#pragma once

#include <vector>

#include "base/progress.h"
#include "cuda/surface/sample.h"
#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Those of poisson_boltzmann(), all with the same coefficients. @param probes in the map's frame
std::vector<std::vector<double>> pb_contributions(const MapGrid& map, const std::vector<PotentialReading>& readings,
                                                  const std::vector<ProbeCharge>& probes, const Progress& progress);

}  // namespace espdiff::ESPDIFF_BACKEND
