// trajectory_study.h: a run over frames: states, potentials, radii, steps, tables. Of files it is one call, for the
// command line and Python; Tcl, which gives VMD's frames one by one, takes the same steps itself.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "options/options.h"
#include "study/pair_maps.h"
#include "study/series_states.h"
#include "study/state.h"
#include "trajectory/trajectory.h"
#include "trajectory/trajectory_settings.h"

namespace espdiff {

/// What is asked for.
struct TrajectoryStudy {
  std::string source;  ///< a structure, or a topology, whose coordinates are then those of a frame
  int source_model = 1;
  std::vector<std::string> frames;         ///< files
  std::string frames_of;                   ///< a structure or topology of the frames' own atoms; empty: the source's
  std::vector<std::string> source_frames;  ///< files; frame i is compared with frame i of these
  bool against_previous = false;           ///< each frame is compared with the one before it
  std::string plugins;                     ///< folder of VMD's molfile plugins; empty: find_molfile_folder()
  StructureOptions structure{};
  PairMaps maps{};  ///< of all frames
  PotentialRequest potential{};
  CompareOptions options{};
  TrajectoryRequest request{};
  std::string picture;                                ///< of the rows, which the caller draws; empty for none
  std::function<void(const std::string&)> tell = {};  ///< receives a resumed run's warning before its first step

  Reference reference() const {
    if (!source_frames.empty()) return Reference::kSame;
    return against_previous ? Reference::kPrevious : Reference::kOne;
  }
};

/// The options that name its files, in the order of the manuals; those of the maps are pair_map_settings().
const std::vector<OptionRow<TrajectoryStudy>>& trajectory_file_settings();

/// Refuses what cannot be, before anything is read. @throws InputError, as check_request() and check_outputs()
void check_study(const TrajectoryStudy& study);

/// Checks, reads, compares and writes all frames.
/// @throws as check_study(), MovingState, PotentialPlan, parse_frames(), begin_trajectory(), TrajectoryRun::step();
///         InputError (trajectories of different lengths)
TrajectorySummary run_trajectory(const TrajectoryStudy& study, Engine& engine, const Progress& progress);

/// Where the states of a run come from: files, or what VMD has.
class StepStates {
 public:
  virtual ~StepStates() = default;
  /// Reads a side of a step, or the one source of all frames.
  /// @param frame  none for the one source
  /// @param states has the source that a frame is compared with
  virtual ComparedState read(StateRole role, std::optional<int> frame, const SeriesStates& states,
                             const Progress& progress) = 0;
  /// The state that has the map of what was read last.
  virtual const State& given(StateRole role) const = 0;
  /// Inputs that all rows depend on, as far as they were read.
  virtual std::vector<InputFile> inputs(const SeriesStates& states) const = 0;
};

/// A run over frames, one step after the other.
class TrajectorySteps {
 public:
  /// Begins the run, or continues it, as begin_trajectory(). Keeps references.
  /// @param plan   with its frames, source, options and parts
  /// @param run    with its molecules and potentials in words
  /// @param states may have the one source of all frames; otherwise the first step takes it
  TrajectorySteps(const TrajectoryRequest& request, TrajectoryPlan plan, SeriesDescription run, StepStates& given,
                  SeriesStates& states);

  TrajectoryRun& run() { return *run_; }
  /// Compares the next frame and adds its row, as TrajectoryRun::step(). What fails about the one source of all frames
  /// ends the run, whatever is to be done about errors of frames.
  const SeriesRow* step(Engine& engine, const Progress& progress);
  /// All steps that are left; where they are independent, several beside each other.
  void finish(Engine& engine, const Progress& progress);

 private:
  void take_source(std::optional<int> frame, const Progress& progress);
  /// The source of all frames, before the first of them is read.
  void take_one_source(const Progress& progress);
  StepInput read(const TrajectoryStep& step, const Progress& progress);

  StepStates& given_;
  SeriesStates& states_;
  bool has_one_source_;
  std::unique_ptr<TrajectoryRun> run_;
};

}  // namespace espdiff
