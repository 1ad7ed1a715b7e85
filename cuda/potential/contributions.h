// contributions.h: what each charge adds to readings of the potential that it is part of (see Engine::contributions).
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "cuda/potential/pme.h"
#include "cuda/surface/sample.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The places of a map's charges, then those of the probes.
std::vector<Vec3d> charge_places(const MapOrigin& origin, const std::vector<ProbeCharge>& probes);
/// Turns what unit charges add into what the map's charges and the probes add.
void scale_by_charges(const MapOrigin& origin, const std::vector<ProbeCharge>& probes, std::vector<double>& of_unit);

/// @param pme the engine's, for its plans and workspace
std::vector<std::vector<double>> contributions(const MapGrid& map, const std::vector<PotentialReading>& readings,
                                               const std::vector<ProbeCharge>& probes, PmeSolver& pme,
                                               const Progress& progress);
std::shared_ptr<MapGrid> without_values(const MapGrid& map);

/// Those of poisson_boltzmann(), all with the same coefficients. @param probes in the map's frame
std::vector<std::vector<double>> pb_contributions(const MapGrid& map, const std::vector<PotentialReading>& readings,
                                                  const std::vector<ProbeCharge>& probes, const Progress& progress);

}  // namespace espdiff::ESPDIFF_BACKEND
