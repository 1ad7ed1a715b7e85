// map_pair.cpp: reads, checks and converts the maps of a comparison.
#include "scene/map_pair.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/units.h"
#include "io/grids/read_grid.h"
#include "scene/map_sampling.h"

namespace espdiff {
namespace {

/// The comparison's potentials must be reproduced within this fraction of their range ...
constexpr double kTolerance = 1e-3;
/// ... except at this fraction of the vertices: those on a map's border.
constexpr double kBorderShare = 1e-3;

/// @throws as the readers; InputError if the file differs from the one compared
std::shared_ptr<Grid> read_recorded(const RecordedInput& input, const std::string& unit, double temperature_K) {
  std::error_code ignored;
  if (!std::filesystem::exists(input.path, ignored)) throw InputError(input.path + " no longer exists");
  GridFile file = read_grid_file(input.path);
  if (file.sha256 != input.sha256) throw InputError(input.path + " has changed since the comparison");
  auto map = std::make_shared<Grid>(std::move(file.grid));
  const std::string name = without_vacuum(unit);
  const PotentialUnit to = name.empty() || name == "unknown" ? PotentialUnit::kUnknown : parse_potential_unit(name);
  if (map->unit != PotentialUnit::kUnknown && to != PotentialUnit::kUnknown && map->unit != to) {
    const auto factor = static_cast<float>(conversion_factor(map->unit, to, temperature_K));
    for (float& value : map->values) value *= factor;
    map->unit = to;
  }
  return map;
}

/// @throws InputError if the map does not reproduce the comparison's values
void check_values(const Grid& map, const std::vector<Vec3d>& positions, const std::vector<float>& expected) {
  const LatticeIndex index(map.lattice, map.name);
  const auto finite = [](float v) { return std::isfinite(v); };
  double low = 0, high = 0;
  for (const float value : expected) {
    if (!finite(value)) continue;
    low = std::min<double>(low, value);
    high = std::max<double>(high, value);
  }
  std::size_t n_off = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const float value = sample_at(map, index(positions[i]));
    const bool agrees = finite(value) == finite(expected[i]) &&
                        (!finite(value) || std::abs(value - expected[i]) <= kTolerance * (high - low) + 1e-12);
    n_off += agrees ? 0 : 1;
  }
  if (static_cast<double>(n_off) > kBorderShare * static_cast<double>(positions.size())) {
    throw InputError(map.name + " gives other potentials than the comparison found, at " + std::to_string(n_off) +
                     " of " + std::to_string(positions.size()) + " vertices");
  }
}

}  // namespace

MapPair read_map_pair(const RunRecord& record, const SurfaceFile& surface) {
  MapPair maps;
  const auto without = [&](const std::string& reason) {
    maps.source = maps.target = nullptr;
    maps.why_not = reason;
    return maps;
  };
  if (surface.potential_source.empty() || surface.potential_target.empty())
    return without("the file has no potentials");
  if (surface.source_positions.empty()) return without("the file has no source positions");
  if (!record.found) return without(record.path + " is missing, which names the maps");
  if (record.maps_computed) return without("the potentials were computed in process, and there are no map files");
  if (record.offset_A != 0) return without("the potentials were read outside the surface, not on it");
  if (record.source_map.path.empty() || record.target_map.path.empty()) {
    return without(record.path + " names no maps");
  }
  try {
    const auto source = read_recorded(record.source_map, surface.potential_unit, record.temperature_K);
    const auto target = read_recorded(record.target_map, surface.potential_unit, record.temperature_K);
    check_values(*source, surface.source_positions, surface.potential_source);
    check_values(*target, surface.positions, surface.potential_target);
    maps.source = source;
    maps.target = target;
  } catch (const Error& error) {
    return without(error.what());
  }
  return maps;
}

}  // namespace espdiff
