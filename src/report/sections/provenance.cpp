// provenance.cpp: computed maps among the inputs.
#include "report/sections/provenance.h"

#include "mapping/map_recipe.h"
#include "potential/computed_map.h"

namespace espdiff {

InputFile computed_input(const std::string& role, const ComputedMap& map) {
  return {role, to_string(map.recipe().method) + " of " + map.recipe().charges_from, map.fingerprint(),
          std::make_shared<const MapRecipe>(map.recipe())};
}

}  // namespace espdiff
