// series_head.h: head of a trajectory's CSV file: everything that the rows depend on; the same from all front ends.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "compare/series.h"
#include "options/options.h"
#include "trajectory/series_csv.h"

namespace espdiff {

/// A run as the user described it. Potentials are in the words of Tcl: `pme ...`, `file PATH ...`, `none`.
struct SeriesDescription {
  std::vector<std::string> files;  ///< whose models are the frames
  StructureOptions structure;      ///< how they are read
  SeriesHead molecule;             ///< instead of files: a molecule of VMD
  std::vector<int> frames;
  std::string frames_of;                     ///< file of the frames' own atoms; empty: those of the reference
  std::string reference;                     ///< `file PATH`, `frame N`, `previous`, ...
  std::vector<std::string> reference_files;  ///< whose frames are the sources
  std::string map = "none";                  ///< of each frame
  std::string reference_map;                 ///< of the reference; empty: as `map`
  StartFrom start = StartFrom::kPrevious;
};

/// Everything that rows depend on: version, frames, reference, potentials, settings that differ from their defaults,
/// and SHA-256 of the files. TrajectoryRun::note_inputs() adds the rest when the reference has been read.
/// @throws IoError (a file is missing or unreadable)
SeriesHead series_head(const SeriesDescription& run, const CompareOptions& options);

}  // namespace espdiff
