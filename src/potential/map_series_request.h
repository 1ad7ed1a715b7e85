// map_series_request.h: what `espdiff potential` is asked for besides the method's own options, once for the command
// line and Tcl.
#pragma once

#include <string>
#include <vector>

#include "base/text/option_row.h"
#include "potential/potential_settings.h"

namespace espdiff {

struct MapSeriesRequest {
  PotentialMethod method = PotentialMethod::kPme;
  std::string cell, xsc_file;  ///< of every frame; empty: each frame's own
  AlignAtoms align = AlignAtoms::kNone;
  bool each = false;  ///< a map of each frame instead of their mean
  std::size_t frames_per_block = 1;
};

/// In the order of the manuals.
const std::vector<OptionRow<MapSeriesRequest>>& map_series_settings();

/// How the request's potentials are computed.
/// @throws InputError (a cell twice, or where the method has none), IoError, as make_potential_options()
PotentialOptions options_of(const MapSeriesRequest& request, const GivenPotentialSettings& given, double temperature_K);

}  // namespace espdiff
