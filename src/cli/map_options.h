// map_options.h: the potentials of two sides on the command line: maps in files, or computed ones.
#pragma once

#include <string>

#include "cli/options.h"
#include "potential/potential_plan.h"
#include "study/state.h"

namespace espdiff::cli {

/// Adds the options of potentials that are computed instead of read.
void add_computed_map_options(CLI::App& parser, PotentialRequest& request);

struct MapArguments : PotentialRequest {
  std::string source_map, target_map, source_map_unit, target_map_unit, map_array;
};
void add_map_options(CLI::App& parser, MapArguments& arguments);
/// Whether maps are read.
inline bool has_given_maps(const MapArguments& a) { return !(a.source_map.empty() && a.target_map.empty()); }
/// @throws InputError (computed and given maps)
void check_map_options(const MapArguments& arguments);

/// A state with the map that was given for a side.
State with_given_map(const MapArguments& arguments, bool is_source);

}  // namespace espdiff::cli
