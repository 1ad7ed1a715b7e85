// potential_json.h: computed potentials in a result's JSON and tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "mapping/map_recipe.h"

namespace espdiff {

struct CompareResult;

/// All parameters of a computed map, and what its computation reported.
nlohmann::ordered_json recipe_json(const MapRecipe& recipe);

/// What kind of potential a result is of, where its zero lies, and what to know of it; null where both maps were given
/// or there are none.
nlohmann::ordered_json potential_json(const CompareResult& result);

/// How the given maps compare with the potentials of the molecules' charges (MapCheck), by side; null for a side whose
/// map was computed or not checked.
nlohmann::ordered_json given_maps_json(const CompareResult& result);

/// The unit of a result's potentials as files, tables and legends name it: "kT/e", of those without a solvent
/// "kT/e in vacuum".
std::string potential_unit_text(const CompareResult& result);

/// "Poisson-Boltzmann, 0.15 mol/l"; of two kinds both; empty where there are none, or both were given and
/// neither is one in vacuum.
std::string potential_label(const CompareResult& result);

}  // namespace espdiff
