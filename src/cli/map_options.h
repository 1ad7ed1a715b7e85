// map_options.h: the potentials of two sides on the command line: maps in files, or computed ones.
#pragma once

#include "cli/options.h"
#include "potential/potential_plan.h"
#include "study/pair_maps.h"

namespace espdiff::cli {

/// Adds the options of potentials that are computed instead of read.
void add_computed_map_options(CLI::App& parser, PotentialRequest& request);

struct MapArguments : PotentialRequest, PairMaps {};
void add_map_options(CLI::App& parser, MapArguments& arguments);
/// @throws InputError (computed and given maps)
void check_map_options(const MapArguments& arguments);

}  // namespace espdiff::cli
