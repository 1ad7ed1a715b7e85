// contributions.cu: the transpose of a computed potential by its method; that of isolated charges here.
#include "cuda/potential/pb/contributions.h"

#include <algorithm>
#include <iterator>

#include "base/error.h"
#include "cuda/potential/coulomb.h"
#include "cuda/potential/map_origin.h"
#include "cuda/potential/pb/pb_contributions.h"
#include "system/this_process.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Coulomb's law is symmetric: the weights are charges, and the charges are where their potential is read.
std::vector<double> coulomb_contributions(const MapOrigin& origin, const WeightedPlaces& reading,
                                          const std::vector<ProbeCharge>& probes) {
  const std::vector<float> weights(reading.weight.begin(), reading.weight.end());
  const ChargeSums sums(reading.place, weights, coulomb_in_kt(origin.coulomb.temperature_K) / origin.coulomb.dielectric,
                        origin.coulomb.distance_dependent);
  const ChargeSumsView view = sums.view();
  const Buffer<Vec3d> positions = to_device(charge_places(origin, probes));
  Buffer<double> found(positions.size());
  const Vec3d* const at = raw(positions);
  double* const out = raw(found);
  for_each_index(positions.size(), [=] ESPDIFF_HD(std::size_t i) { out[i] = view.isolated(at[i]); });
  std::vector<double> result = to_host(found);
  scale_by_charges(origin, probes, result);
  return result;
}

}  // namespace

std::vector<std::vector<double>> contributions(const MapGrid& map, const std::vector<PotentialReading>& readings,
                                               const std::vector<ProbeCharge>& given, PmeSolver& pme,
                                               const Progress& progress) {
  if (map.origin == nullptr)
    throw InputError("a given potential map does not say which charges it is made of; let the potential be computed");
  const MapOrigin& origin = *map.origin;
  std::vector<ProbeCharge> probes = given;
  for (ProbeCharge& probe : probes) probe.position = origin.to_map.apply(probe.position);
  return_free_memory();  // the solver's large arrays do not fit into what the stages before left free
  if (origin.method == PotentialMethod::kPoissonBoltzmann) return pb_contributions(map, readings, probes, progress);
  std::vector<std::vector<double>> result;
  for (const PotentialReading& reading : readings) {
    progress.report("causes", static_cast<double>(result.size()) / static_cast<double>(readings.size()));
    const WeightedPlaces places = weighted_places(map, reading);
    result.push_back(origin.method == PotentialMethod::kPme ? pme.contributions(map, places, probes)
                                                            : coulomb_contributions(origin, places, probes));
  }
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
