// series_head.h: what a trajectory's rows depend on, in the words of its CSV file: the same from every front end.
#pragma once

#include <string>
#include <vector>

#include "base/structure_options.h"
#include "compare/options.h"
#include "compare/series.h"
#include "trajectory/series_csv.h"

namespace espdiff {

/// A run as its user described it. Potentials are in the words of Tcl: `pme ...`, `file PATH ...`, `none`.
struct SeriesDescription {
  std::vector<std::string> files;  ///< whose models are the frames
  StructureOptions structure;      ///< how they are read
  SeriesHead molecule;             ///< instead of files: what VMD holds
  std::vector<int> frames;
  std::string reference;      ///< `file PATH`, `frame N`, `previous`, ...
  std::string map = "none";   ///< of each frame
  std::string reference_map;  ///< of the reference; empty by the rule of `map`
  StartFrom start = StartFrom::kPrevious;
};

/// Version, frames, reference, potentials, settings that are not the usual ones, and the files' SHA-256. What is known
/// only when the reference is read is added by TrajectoryRun::note_inputs().
/// @throws IoError (a file is missing or unreadable)
SeriesHead series_head(const SeriesDescription& run, const CompareOptions& options);

}  // namespace espdiff
