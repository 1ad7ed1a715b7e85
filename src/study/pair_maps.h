// pair_maps.h: potential maps that are given as files for both sides, and their options.
#pragma once

#include <string>
#include <vector>

#include "base/text/option_row.h"
#include "study/state.h"

namespace espdiff {

struct PairMaps {
  std::string source_map, target_map, source_map_unit, target_map_unit, map_array;

  bool any() const { return !(source_map.empty() && target_map.empty()); }
  /// A state with the map of a side, and nothing else.
  State of(bool is_source) const;
};

/// In the order of the manuals.
const std::vector<OptionRow<PairMaps>>& pair_map_settings();

}  // namespace espdiff
