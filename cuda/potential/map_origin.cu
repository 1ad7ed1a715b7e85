// map_origin.cu: charges of a map, and a map without its values.
#include "cuda/potential/map_origin.h"

#include <algorithm>
#include <iterator>

#include "cuda/surface/sample.h"

namespace espdiff::ESPDIFF_BACKEND {

std::vector<Vec3d> charge_places(const MapOrigin& origin, const std::vector<ProbeCharge>& probes) {
  std::vector<Vec3d> places = origin.positions;
  for (const ProbeCharge& probe : probes) places.push_back(probe.position);
  return places;
}

void scale_by_charges(const MapOrigin& origin, const std::vector<ProbeCharge>& probes, std::vector<double>& of_unit) {
  const std::size_t n = origin.charges.size();
  for (std::size_t i = 0; i < n; ++i) of_unit[i] *= static_cast<double>(origin.charges[i]);
  for (std::size_t i = 0; i < probes.size(); ++i) of_unit[n + i] *= static_cast<double>(probes[i].charge);
}

std::shared_ptr<MapGrid> without_values(const MapGrid& map) {
  auto result = std::make_shared<MapGrid>();
  result->lattice = map.lattice;
  result->unit = map.unit;
  std::copy(std::begin(map.to_index), std::end(map.to_index), result->to_index);
  result->periodic = map.periodic;
  result->spline_order = map.spline_order;
  result->origin = map.origin;
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
