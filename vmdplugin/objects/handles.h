// handles.h: objects with handles in Tcl: comparisons, surfaces, trajectories and so on. They belong to the interpreter
// that made them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "certificate/result.h"
#include "engine/select_engine.h"
#include "frames/frame_files.h"
#include "mapping/build_surface.h"
#include "options/options.h"
#include "potential/potential.h"
#include "potential/potential_series.h"
#include "study/matrix_study.h"
#include "study/pair_study.h"
#include "study/series_states.h"
#include "study/trajectory_study.h"
#include "vmdplugin/bridge/worker.h"
#include "vmdplugin/values/endpoint.h"

namespace espdiff::vmdplugin {

/// Where and how a job computes.
struct Computation {
  CompareOptions options;
  ComputingOptions computing;
  std::string command_line;  ///< the user's command, for the provenance
};

/// Base of all objects with handles.
struct Object {
  virtual ~Object() = default;
  virtual const char* kind() const = 0;
  std::shared_ptr<Job> job;  ///< that computes it; null if there is none
};

/// One pair.
struct ComparisonObject : Object, PairAnswer {
  const char* kind() const override { return "comparison"; }
  Computation computation;
  PairStudy study;
};

/// A structure that gets charges, and the PQR file that it is written to.
struct PreparationObject : Object {
  const char* kind() const override { return "preparation"; }
  Computation computation;
  State molecule;
  LoadedState state;  ///< made by the job
  std::string path;
};

struct SurfaceObject : Object {
  const char* kind() const override { return "surface"; }
  StatePtr given;
  Molecule molecule;  ///< with the radii of its surface
  Computation computation;
  SurfaceResult result;
};

/// Many variants, each with each.
struct MatrixObject : Object {
  const char* kind() const override { return "matrix"; }
  Computation computation;
  MatrixStudy study;
  MatrixReport report;
};

/// Frames compared one after the other; rows in a file.
struct TrajectoryObject : Object, StepStates {
  const char* kind() const override { return "trajectory"; }
  TrajectoryRun& run() const { return steps->run(); }

  ComparedState read(StateRole role, std::optional<int> frame, const SeriesStates& states,
                     const Progress& progress) override;
  const State& given(StateRole role) const override { return role == StateRole::kSource ? *source : *target; }
  std::vector<InputFile> inputs(const SeriesStates& states) const override;

  Computation computation;
  Reference against = Reference::kOne;
  bool one_map = false;  ///< the target's map is the same for all frames
  /// Of a run over a file's models, and against those of another.
  std::unique_ptr<FrameFiles> files, source_files;
  StatePtr source, target;  ///< of the next step, as Tcl gave them
  SeriesStates states{computation.options};
  std::unique_ptr<Engine> engine;          // made by the first step's job
  std::unique_ptr<TrajectorySteps> steps;  // destroyed before what it points to
  std::optional<SeriesRow> row;            ///< that the last step added
};

/// Potentials of frames, one after the other, and their average.
struct PotentialObject : Object {
  const char* kind() const override { return "potential"; }
  ComputingOptions computing;
  PotentialOptions potential;
  bool keeps_frames = false;                // each frame's own map is wanted
  Grid frame;                               // the last one's, if so
  std::shared_ptr<Engine> engine;           // made, like what follows, by the first frame's job
  std::unique_ptr<PotentialSeries> series;  // destroyed before the engine
};

/// The objects of one interpreter.
class Handles {
 public:
  ~Handles();

  /// Returns the new handle, such as "comparison1"; numbers are not used again.
  std::string add(const std::shared_ptr<Object>& object);
  /// @throws InputError that lists what there is
  std::shared_ptr<Object> find(const std::string& handle) const;
  /// An object of one kind, whose job has succeeded.
  /// @throws InputError (another kind; not finished), and the job's own failure
  std::shared_ptr<ComparisonObject> finished_comparison(const std::string& handle) const;
  std::shared_ptr<TrajectoryObject> find_trajectory(const std::string& handle) const;
  std::shared_ptr<PotentialObject> find_potential(const std::string& handle) const;
  std::shared_ptr<MatrixObject> finished_matrix(const std::string& handle) const;
  /// Cancels its job and waits for it to stop.
  void remove(const std::string& handle);
  std::vector<std::string> names() const;

 private:
  std::map<std::string, std::shared_ptr<Object>> objects_;
  std::map<std::string, int> last_number_;  ///< by kind
};

/// "a comparison", "an ensemble"
std::string kind_in_words(const Object& object);

/// An error by the name of its class, such as "INPUT"; of an unknown one an internal error.
Error error_of_class(const std::string& name, const Message& message);

/// @throws the failure of the object's job; InputError while it is not finished
void require_done(const std::string& handle, const Object& object);

}  // namespace espdiff::vmdplugin
