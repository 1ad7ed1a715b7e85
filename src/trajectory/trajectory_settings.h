// trajectory_settings.h: what a run over frames is asked for besides its molecules and the comparison's options, once
// for the command line, Tcl and Python; and how such a run begins.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text/option_row.h"
#include "compare/series.h"
#include "trajectory/series_head.h"
#include "trajectory/trajectory.h"

namespace espdiff {

struct TrajectoryRequest {
  std::string csv;                 ///< table of the rows
  std::string frames = "all";      ///< as parse_frames() reads it
  std::optional<StartFrom> start;  ///< none: usual_start()
  std::string residues;            ///< table of residues; empty: none
  std::string residue_quantity;    ///< empty: usual_residue_quantity()
  bool resume = false, overwrite = false, skip_errors = false;

  StartFrom start_of(const CompareOptions& options) const { return start ? *start : usual_start(options); }
};

/// In the order of the manuals.
const std::vector<OptionRow<TrajectoryRequest>>& trajectory_settings();

/// Refuses what cannot be together, before anything is read.
/// @param inputs  files besides those that the options name
/// @param picture a further output; empty for none
/// @throws InputError (resume and overwrite; a residue quantity that does not exist, or without a table), as
///         check_outputs()
void check_request(const TrajectoryRequest& request, const CompareOptions& options, std::vector<std::string> inputs,
                   const std::string& picture = {});

/// Begins a run, or continues it: opens its tables.
/// @param plan with its frames, source, options and parts; start and errors are set from the request
/// @param run  with its molecules and potentials in words; frames and start are set from the plan
/// @throws as series_head(), ResidueCsv, SeriesCsv, TrajectoryRun
std::unique_ptr<TrajectoryRun> begin_trajectory(const TrajectoryRequest& request, TrajectoryPlan plan,
                                                SeriesDescription run);

}  // namespace espdiff
