// moving_state.h: one molecule's frames in files, and the state that gives them what the files lack.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "frames/frame_files.h"
#include "study/state.h"

namespace espdiff {

/// What all molecules of a run over files are read by.
struct MovingStateOptions {
  StructureOptions structure;
  std::string plugins;  ///< folder of VMD's molfile plugins; empty: find_molfile_folder()
  PotentialRequest potential{};
  bool has_maps = false;  ///< they are given, so that charges are not needed
};

/// Frames, and their state: atoms, charges, radii.
class MovingState {
 public:
  /// Loads the state. Keeps a reference to progress.
  /// @param topology a structure, or a topology, whose coordinates are then those of a frame or of a structure in files
  /// @param model    of a structure with several, from 1; of a topology the frame of the first trajectory
  /// @param files    of the frames; none where the state alone is compared
  /// @throws as load_for(), TrajectoryOpener::open()
  MovingState(MovingStateOptions options, StateRole role, const std::string& topology, int model,
              const std::vector<std::string>& files, const InputOptions& input, const Progress& progress);
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
  void load(const std::string& topology, int model, const std::vector<std::string>& files);

  MovingStateOptions options_;
  StateRole role_;
  InputOptions input_;
  const Progress& progress_;
  TrajectoryOpener opener_;
  std::optional<FrameFiles> frames_;
  LoadedState state_;
  std::vector<InputFile> inputs_;
};

}  // namespace espdiff
