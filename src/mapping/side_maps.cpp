// side_maps.cpp: maps of both sides: checks, units, upload to the device.
#include "mapping/side_maps.h"

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "engine/engine.h"
#include "mapping/map_recipe.h"

namespace espdiff {
namespace {

std::string described(const CompareInput& side) {
  return to_string(unit_of(side)) + " (" + (side.make_map ? "computed" : side.map->name) + ")";
}

Grid in_unit(const Grid& map, PotentialUnit unit, double temperature_K) {
  Grid converted = map;
  const float factor = static_cast<float>(conversion_factor(map.unit, unit, temperature_K));
  for (float& value : converted.values) value *= factor;
  converted.unit = unit;
  return converted;
}

}  // namespace

PotentialUnit unit_of(const CompareInput& side) {
  return side.map != nullptr ? side.map->unit : side.make_map ? PotentialUnit::kKtPerE : PotentialUnit::kUnknown;
}

PotentialUnit common_unit(const CompareInput& source, const CompareInput& target) {
  return unit_of(target.make_map ? target : source);
}

void check_maps(const CompareInput& source, const CompareInput& target) {
  if (has_map(source) != has_map(target)) {
    throw InputError(std::string("a potential map was given for the ") + (has_map(source) ? "source" : "target") +
                     " only; give one for the " +
                     (has_map(source) ? "target too (" + option("target-map") : "source too (" + option("source-map")) +
                     "), or none to compare shapes alone");
  }
  const PotentialUnit source_unit = unit_of(source), target_unit = unit_of(target);
  if (source_unit == target_unit) return;
  if (source_unit == PotentialUnit::kUnknown || target_unit == PotentialUnit::kUnknown) {
    throw InputError("the maps are in two units: " + described(source) + " and " + described(target) +
                     "; name the unknown one's unit (" +
                     option(source_unit == PotentialUnit::kUnknown ? "source-map-unit" : "target-map-unit") + ")");
  }
}

MadeMap device_map(Engine& engine, const CompareInput& side, const RigidTransform& to_map, const MapRequest& request,
                   PotentialUnit unit, double temperature_K, const Progress& progress) {
  if (side.make_map) return side.make_map(engine, to_map, request, progress);
  if (side.map->unit == unit || unit == PotentialUnit::kUnknown) return {engine.upload_map(*side.map, to_map), {}};
  return {engine.upload_map(in_unit(*side.map, unit, temperature_K), to_map), {}};
}

std::size_t count_outside(const CompareInput& side, const std::vector<float>& samples,
                          const std::vector<bool>& counts) {
  std::size_t n = 0;
  bool any_inside = false;
  for (std::size_t v = 0; v < samples.size(); ++v) {
    const bool is_inside = std::isfinite(samples[v]);
    any_inside = any_inside || is_inside;
    if (!is_inside && (counts.empty() || counts[v])) ++n;
  }
  if (any_inside) return n;
  throw InputError(
      (side.map != nullptr ? side.map->name : side.molecule->name) +
      ": the map does not cover the molecule: no vertex of the surface lies in it; compute the map around this "
      "molecule, in the coordinates of the structure file");
}

}  // namespace espdiff
