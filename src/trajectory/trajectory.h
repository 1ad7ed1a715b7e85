// trajectory.h: each frame of a trajectory against one source, row by row into a file, from which a run can be resumed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/handles.h"
#include "compare/input.h"
#include "compare/options.h"
#include "compare/result.h"
#include "trajectory/series_csv.h"

namespace espdiff {

/// A frame as it is compared, with a map that is given, or one that is computed, or none.
struct FrameInput {
  Molecule molecule;
  const Grid* map = nullptr;
  MapMaker make_map = nullptr;  ///< instead of `map`
};

/// A run over frames.
struct Trajectory {
  CompareInput source;
  std::string reference;                       ///< the source, as the rows name it
  std::vector<int> frames;                     ///< in the order in which they are compared
  std::function<FrameInput(int frame)> frame;  ///< reads one
  CompareOptions options;
  StartFrom start = StartFrom::kPrevious;
  bool skip_errors = false;  ///< a frame that cannot be compared is a row that says why, and the run goes on
};

struct TrajectorySummary {
  std::size_t n_frames = 0;
  std::size_t n_rows = 0;     ///< added by this run
  std::size_t n_skipped = 0;  ///< of these, without numbers
  std::size_t n_resumed = 0;  ///< in the file before
};

/// Compares each frame with the source and adds its row to the file as it is done. Rows that the file has already are
/// not computed again: their frames must be the run's first ones.
///
/// Where mappings start from the previous frame's, that mapping is kept in FILE.state while the run
/// lasts, so that a resumed run gives the same rows as one that was not interrupted. Where a run broke off between a
/// row and its mapping, that row is computed again, and must come out as it stands. Without a usable state the next
/// mapping starts from the source; `warn` is told why.
/// @param progress its stage names the frame; its share is that of the run
/// @throws as Series::step() and `frame`, with the frame's number in front; Cancelled (rows so far stay); InputError
/// (rows
///         of other frames; a row that comes out otherwise)
TrajectorySummary compare_frames(Engine& engine, const Trajectory& run, SeriesCsv& file, const Progress& progress,
                                 const std::function<void(const std::string&)>& warn);

}  // namespace espdiff
