// contributions.cu: the transpose of a computed potential by its method; that of isolated charges here.
#include "cuda/potential/contributions.h"

#include "base/error.h"
#include "cuda/potential/coulomb.h"
#include "cuda/potential/map_origin.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Coulomb's law is symmetric: the weights are charges, and the charges are where their potential is read.
std::vector<double> coulomb_contributions(const MapOrigin& origin, const WeightedPlaces& reading) {
  const std::vector<float> weights(reading.weight.begin(), reading.weight.end());
  const ChargeSums sums(reading.place, weights, coulomb_in_kt(origin.coulomb.temperature_K) / origin.coulomb.dielectric,
                        origin.coulomb.distance_dependent);
  const ChargeSumsView view = sums.view();
  const Buffer<Vec3d> positions = to_device(origin.positions);
  Buffer<double> found(positions.size());
  const Vec3d* const at = raw(positions);
  double* const out = raw(found);
  for_each_index(positions.size(), [=] ESPDIFF_HD(std::size_t i) { out[i] = view.isolated(at[i]); });
  std::vector<double> result = to_host(found);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] *= static_cast<double>(origin.charges[i]);
  return result;
}

}  // namespace

std::vector<std::vector<double>> contributions(const MapGrid& map, const SurfaceMesh& mesh,
                                               const std::vector<std::vector<double>>& weights, PmeSolver& pme,
                                               const Progress& progress) {
  if (map.origin == nullptr)
    throw InputError("a given potential map does not say which charges it is made of; let the potential be computed");
  std::vector<WeightedPlaces> readings;
  for (const std::vector<double>& of_reading : weights) readings.push_back(weighted_places(map, mesh, of_reading));
  const MapOrigin& origin = *map.origin;
  if (origin.method == PotentialMethod::kPoissonBoltzmann) return pb_contributions(map, readings, progress);
  std::vector<std::vector<double>> result;
  for (const WeightedPlaces& reading : readings) {
    progress.report("causes", static_cast<double>(result.size()) / static_cast<double>(readings.size()));
    result.push_back(origin.method == PotentialMethod::kPme ? pme.contributions(map, reading)
                                                            : coulomb_contributions(origin, reading));
  }
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
