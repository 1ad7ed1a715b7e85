// trajectory.h: a run over frames, one step for each frame; the rows are in a file that can be resumed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/handles.h"
#include "compare/series.h"
#include "mapping/input.h"
#include "options/options.h"
#include "report/sections/provenance.h"
#include "trajectory/residue_csv.h"
#include "trajectory/series_csv.h"

namespace espdiff {

struct StateOrigin;

/// What each frame is compared with: one source, the frame before it, or the frame of the same number of another
/// trajectory.
enum class Reference { kOne, kPrevious, kSame };

/// Frames of a run, and what they are compared with.
struct TrajectoryPlan {
  std::vector<int> frames;  ///< in the order of comparison
  Reference against = Reference::kOne;
  std::string reference;  ///< the one source, as the rows name it
  CompareOptions options;
  StartFrom start = StartFrom::kPrevious;
  bool skip_errors = false;   ///< a frame that fails becomes a row with the error, and the run continues
  PartsAndFields compared{};  ///< region and patches of the sources, and fields, whose numbers are in further columns
};

/// Default start of mappings: the source (morph) or the frame before (deform).
StartFrom usual_start(const CompareOptions& options);

/// One frame to compare.
struct TrajectoryStep {
  int frame = 0;
  std::optional<int> source;  ///< frame that is its source, unless all have one
  std::string reference;      ///< the source, as the row names it
};

/// The two sides of a step. The objects they point to must live as long as `held`, or else until the step ends; the
/// common source of all frames until the run ends.
struct StepInput {
  CompareInput source, target;
  std::vector<InputFile> inputs{};             ///< inputs that all rows depend on; see TrajectoryRun::note_inputs()
  const StateOrigin* source_origin = nullptr;  ///< for the row's warnings; both or none
  const StateOrigin* target_origin = nullptr;
  std::shared_ptr<const void> held{};  ///< keeps the target in memory
};

struct TrajectorySummary {
  std::size_t n_frames = 0;   ///< frames that have a row
  std::size_t n_rows = 0;     ///< rows added by this run
  std::size_t n_skipped = 0;  ///< rows with an error instead of numbers
  std::size_t n_resumed = 0;  ///< rows that were in the file before
  std::size_t n_trusted = 0;  ///< trustworthy rows, of all in the file
};

/// A run over frames. Existing rows are not computed again; they must be of the run's first frames.
///
/// If mappings start from the previous frame's, FILE.state keeps that mapping during the run, so that a resumed run
/// gives the same bytes as an uninterrupted one. If a run was interrupted between writing a row and its mapping, that
/// row is computed again and must be the same. Without a usable state the next mapping starts from the source, and
/// warning() says so.
class TrajectoryRun {
 public:
  /// @throws InputError (no frames; rows of other frames), as ResidueCsv::resume()
  /// @param residues receives the residues of each frame as well
  TrajectoryRun(TrajectoryPlan plan, SeriesCsv file, std::optional<ResidueCsv> residues = std::nullopt);

  bool is_done() const { return position_ == steps_.size(); }
  /// The next step. @pre !is_done()
  const TrajectoryStep& next() const { return steps_.at(position_); }
  /// Why the first mapping of a resumed run starts from the source; usually empty.
  const std::string& warning() const { return warning_; }
  const SeriesCsv& file() const { return file_; }
  TrajectorySummary summary() const;

  /// Adds inputs that all rows depend on to the head, by SHA-256: the source, and a map that all frames share.
  /// @throws InputError (the file was made with others)
  void note_inputs(const std::vector<InputFile>& inputs);

  /// Compares the next frame and adds its row, or computes an existing row again.
  /// @param read returns the sides; its errors count as the frame's
  /// @param progress its stage is "frame N: STAGE", its share that of the run
  /// @returns the added row; null if it existed
  /// @throws as Series::step() and `read`, with the frame's number in front; Error of class kCancelled (rows so far
  ///         stay); InputError (a row that is computed again differs); IoError
  const SeriesRow* step(Engine& engine, const std::function<StepInput()>& read, const Progress& progress);
  /// Whether no step depends on another one: all have one source, from which their mappings start.
  bool is_independent() const;
  /// Compares all frames that are left, several beside each other: rows, their order and their bytes are those of one
  /// step after the other. @pre is_independent(), !is_done()
  /// @param n_atoms of the source; frames have about as many
  /// @param read as for step(), of the step; it is called a few frames ahead, and its input holds its target
  /// @throws as step()
  void finish(Engine& engine, std::size_t n_atoms, const std::function<StepInput(const TrajectoryStep&)>& read,
              const Progress& progress);
  /// Adds a row with the error of a frame that cannot be read.
  /// @throws Error the same with the frame's number in front, unless errors are skipped
  const SeriesRow* skip(const Error& why);
  /// The error of a cancelled run: the number of rows, and how to continue.
  Error cancelled() const;

 private:
  void check_earlier_rows() const;
  void restore_mapping();
  SeriesState read_mapping_of(const SeriesRow& row) const;
  bool keeps_mappings() const;
  std::string state_path() const { return file_.path() + ".state"; }
  std::string state_fingerprint(const std::string& frame) const;
  void remove_state() const;
  void resume_residues();
  /// A frame as it is compared, and the result as far as the table of residues needs it.
  struct Compared {
    SeriesRow row;
    StepInput input;
    std::shared_ptr<const CompareResult> result;
  };
  Compared compared(const TrajectoryStep& step, StepInput input, Series& series, StartFrom start,
                    const Progress& progress) const;
  void add_residues(const Compared& frame);
  SeriesRow compare(Engine& engine, StepInput input, const Progress& progress);
  StartFrom start_of_step() const;
  const SeriesRow* end_step(const SeriesRow& row);
  void compare_again(const SeriesRow& row) const;

  TrajectoryPlan plan_;
  SeriesCsv file_;
  std::optional<ResidueCsv> residues_;
  std::optional<ResidueLine> residue_line_;  ///< of the step
  std::vector<TrajectoryStep> steps_;
  std::size_t position_ = 0, n_resumed_ = 0, n_skipped_ = 0;
  std::optional<SeriesState> restored_;  ///< state that the first step continues from
  std::unique_ptr<Series> series_;       ///< of the source of all frames, or of the last step
  std::string warning_;
  double share_ = 0;
};

}  // namespace espdiff
