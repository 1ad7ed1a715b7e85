// trajectory_sides.h: source and frames of `espdiff trajectory`, from its files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "base/types.h"
#include "cli/map_options.h"
#include "cli/options.h"
#include "frames/frame_files.h"
#include "frames/frame_range.h"
#include "study/series_source.h"
#include "trajectory/trajectory.h"
#include "trajectory/trajectory_settings.h"

namespace espdiff::cli {

/// What `espdiff trajectory` was called with.
struct TrajectoryArguments {
  std::string source, output, picture, plugins, frames_of, reference = "source";
  std::vector<std::string> targets, source_frames;
  int source_model = 1;
  bool quiet = false;
  TrajectoryRequest request;
  MapArguments maps;
  StructureOptions structure;
  DeviceArguments device;
  GivenSettings settings;
};

/// One source for all frames, the frame before, or, with source_frames, the frame of the same number.
Reference reference_of(const TrajectoryArguments& a);

/// One molecule's frames, and the state that gives them what their files lack: atoms, charges, radii.
class MovingState {
 public:
  /// Loads the state. Keeps references to a, options and progress.
  /// @param topology a structure, or a topology, whose coordinates are then those of a frame
  /// @param files    of the frames; none where the state alone is compared
  /// @throws as load_for(), TrajectoryOpener::open()
  MovingState(const TrajectoryArguments& a, StateRole role, const std::string& topology,
              const std::vector<std::string>& files, const InputOptions& options, const Progress& progress);
  /// Other frames of the same molecule.
  MovingState(const MovingState& like, StateRole role, const std::string& topology,
              const std::vector<std::string>& files);

  const LoadedState& state() const { return state_; }
  /// The files that the state is from.
  const std::vector<InputFile>& inputs() const { return inputs_; }
  int n_frames() const { return frames_->n_frames(); }
  const std::string& incomplete() const { return frames_->incomplete(); }
  /// @throws as load_frame_state()
  ComparedState read(int number, StateRole role, const PotentialPlan& potential);

 private:
  void open(const std::vector<std::string>& files);
  void load(const std::string& topology, const std::vector<std::string>& files);

  const TrajectoryArguments& a_;
  StateRole role_;
  const InputOptions& options_;
  const Progress& progress_;
  TrajectoryOpener opener_;
  std::optional<FrameFiles> frames_;
  LoadedState state_;
  std::vector<InputFile> inputs_;
};

/// Source and frames, and how their molecules become a comparison's inputs.
class TrajectorySides {
 public:
  /// Keeps references to all arguments.
  /// @throws as MovingState, PotentialPlan; InputError (trajectories of different lengths)
  TrajectorySides(const TrajectoryArguments& a, const CompareOptions& options, const Progress& progress);

  /// Frames that have a source.
  FrameSet frames() const;
  /// What all rows depend on.
  const std::vector<InputFile>& inputs() const { return inputs_; }
  /// The computed potential in words; empty for none.
  std::string potential() const { return plan_.in_words(); }
  /// The sides of a step, which stay until the next one is asked for.
  StepInput step(const TrajectoryStep& step);

 private:
  void open_targets(const Progress& progress);
  MovingState& targets() { return second_ ? *second_ : first_; }
  const MovingState& targets() const { return second_ ? *second_ : first_; }
  void use_source(ComparedState source);

  const TrajectoryArguments& a_;
  const InputOptions& options_;
  Reference reference_;
  MovingState first_;                  // of the source
  std::optional<MovingState> second_;  // of the frames, where they are not the source's molecule
  SeriesSource source_;
  ComparedState target_;
  PotentialPlan plan_;
  double temperature_K_ = 0;       // of the kT in computed maps
  State source_map_, target_map_;  // the given maps of all frames
  std::vector<InputFile> inputs_;
};

}  // namespace espdiff::cli
