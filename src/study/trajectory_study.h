// trajectory_study.h: the whole of a run over frames in files in one call: states, potentials, radii, steps, tables.
// The command line and Python start here; Tcl, which gives VMD's frames one by one, takes its parts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "options/options.h"
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
  State source_map{}, target_map{};  ///< the given maps of all frames, where there are any
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

/// Refuses what cannot be, before anything is read. @throws InputError, as check_request() and check_outputs()
void check_study(const TrajectoryStudy& study);

/// Checks, reads, compares and writes all frames.
/// @throws as check_study(), MovingState, PotentialPlan, parse_frames(), begin_trajectory(), TrajectoryRun::step();
///         InputError (trajectories of different lengths)
TrajectorySummary run_trajectory(const TrajectoryStudy& study, Engine& engine, const Progress& progress);

/// Reads one state of a step: the source's frame, or the target's.
using ReadState = std::function<ComparedState(StateRole role, int frame)>;

/// Compares the next frame of a run and adds its row, as TrajectoryRun::step().
/// @param states has the source, unless each frame has one
/// @param read   reads both sides
/// @param source the state with the map of a frame's own source; null where all frames have one source
/// @param target the state with the frame's map
/// @param inputs that all rows depend on, once the frame was read; may be empty
const SeriesRow* compare_step(TrajectoryRun& run, SeriesStates& states, Engine& engine, const ReadState& read,
                              const State* source, const State& target,
                              const std::function<std::vector<InputFile>()>& inputs, const Progress& progress);

}  // namespace espdiff
