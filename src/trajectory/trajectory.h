// trajectory.h: a run over frames, driven frame by frame by whoever has them; rows in a file that can be resumed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/handles.h"
#include "compare/input.h"
#include "compare/options.h"
#include "compare/series.h"
#include "report/provenance.h"
#include "trajectory/series_csv.h"

namespace espdiff {

/// Which frames a run compares with what.
struct TrajectoryPlan {
  std::vector<int> frames;        ///< in the order in which they are compared
  std::string reference;          ///< the source of all frames, as the rows name it
  bool against_previous = false;  ///< instead: each frame of the run with the one before it
  CompareOptions options;
  StartFrom start = StartFrom::kPrevious;
  bool skip_errors = false;  ///< a frame that cannot be compared is a row that says why, and the run goes on
};

/// Where mappings begin unless the user says: at the source by the morph, at the frame before by deform.
StartFrom usual_start(const CompareOptions& options);
/// "auto", "source" or "previous". @throws InputError
StartFrom parse_start(const std::string& text, const CompareOptions& options);

/// One frame that is to be compared.
struct TrajectoryStep {
  int frame = 0;
  std::optional<int> previous;  ///< the frame that is its source, of a run against the frame before
  std::string reference;        ///< the source, as the row names it
};

/// The two sides of a step. What they point to stays until the step ends; the source of all frames until the run ends.
struct StepInput {
  CompareInput source, target;
  std::vector<InputFile> inputs{};  ///< whose contents all rows depend on; see TrajectoryRun::note_inputs()
};

struct TrajectorySummary {
  std::size_t n_frames = 0;   ///< that give a row
  std::size_t n_rows = 0;     ///< added by this run
  std::size_t n_skipped = 0;  ///< of these, without numbers
  std::size_t n_resumed = 0;  ///< in the file before
};

/// A run over frames. Rows that the file has already are not computed again: their frames must be the run's first ones.
///
/// Where mappings start from the previous frame's, that mapping is kept in FILE.state while the run lasts, so that a
/// resumed run gives the same bytes as one that was not interrupted. Where a run broke off between a row and its
/// mapping, that row is computed again, and must come out as it stands. Without a usable state the next mapping starts
/// from the source; warning() says so.
class TrajectoryRun {
 public:
  /// @throws InputError (no frames; rows of other frames)
  TrajectoryRun(TrajectoryPlan plan, SeriesCsv file);

  bool is_done() const { return position_ == steps_.size(); }
  /// The step to do. @pre !is_done()
  const TrajectoryStep& next() const { return steps_.at(position_); }
  /// Why the first mapping of a resumed run starts from the source; empty usually.
  const std::string& warning() const { return warning_; }
  const SeriesCsv& file() const { return file_; }
  TrajectorySummary summary() const;

  /// Inputs that all rows depend on, by their SHA-256: of the source, and of a map that serves all frames.
  /// @throws InputError (the file was made with others)
  void note_inputs(const std::vector<InputFile>& inputs);

  /// Compares the next frame and adds its row, or computes again a row that is there.
  /// @param read gives the sides; an error of it is the frame's
  /// @param progress its stage is "frame N: STAGE", its share that of the run
  /// @returns the row that was added; null where it was there
  /// @throws as Series::step() and `read`, with the frame's number in front; Error of class kCancelled (rows so far
  ///         stay); InputError (a row that is computed again comes out otherwise); IoError
  const SeriesRow* step(Engine& engine, const std::function<StepInput()>& read, const Progress& progress);
  /// The next frame cannot be read: adds a row that says why.
  /// @throws Error the same with the frame's number in front, unless errors are skipped
  const SeriesRow* skip(const Error& why);
  /// What a cancelled run throws: how many rows there are, and how to go on.
  Error cancelled() const;

 private:
  void check_earlier_rows() const;
  void restore_mapping();
  SeriesState read_mapping_of(const SeriesRow& row) const;
  bool keeps_mappings() const;
  std::string state_path() const { return file_.path() + ".state"; }
  std::string state_fingerprint(const std::string& frame) const;
  void remove_state() const;
  SeriesRow compare(Engine& engine, const StepInput& input, const Progress& progress);
  StartFrom start_of_step() const;
  const SeriesRow* end_step(const SeriesRow& row);
  void compare_again(const SeriesRow& row) const;

  TrajectoryPlan plan_;
  SeriesCsv file_;
  std::vector<TrajectoryStep> steps_;
  std::size_t position_ = 0, n_resumed_ = 0, n_skipped_ = 0;
  std::optional<SeriesState> restored_;  ///< what the first step goes on from
  std::unique_ptr<Series> series_;       ///< of the source of all frames, or of the last step
  std::string warning_;
  double share_ = 0;
};

}  // namespace espdiff
