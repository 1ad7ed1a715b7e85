// trajectory_study.cpp: the order of a run's parts.
#include "study/trajectory_study.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.h"
#include "engine/engine.h"
#include "frames/frame_range.h"
#include "io/frames/molfile_plugins.h"
#include "report/state_report.h"
#include "study/moving_state.h"

namespace espdiff {
namespace {

/// A map in the Tcl command's words; empty for none.
std::string map_words(const State& map) {
  if (map.map_path.empty()) return {};
  return "file " + map.map_path + (map.map_unit.empty() ? "" : " unit " + map.map_unit) +
         (map.map_array.empty() ? "" : " array " + map.map_array);
}

/// "file a.pqr"
std::string reference_words(const TrajectoryStudy& study) {
  const Reference reference = study.reference();
  if (reference == Reference::kPrevious) return "previous";
  std::string words = "file " + study.source;
  if (reference == Reference::kSame) {
    for (const std::string& path : study.source_frames) words += " " + path;
    return words + " frame same";
  }
  if (needs_molfile_reader(study.source)) words += " coordinates " + study.frames.front();
  return study.source_model == 1 ? words : words + " model " + std::to_string(study.source_model);
}

/// Source and frames of a study in files, and how their molecules become a comparison's inputs.
class FileStates : public StepStates {
 public:
  /// Keeps references.
  FileStates(const TrajectoryStudy& study, const Progress& progress)
      : study_(study),
        reference_(study.reference()),
        first_(moving_options(), StateRole::kSource, study.source, study.source_model, source_files(),
               study.options.input, progress),
        source_map_(study.maps.of(true)),
        target_map_(study.maps.of(false)),
        states_(study.options) {
    open_targets(progress);
    check_left_out(study.options.input, {&first_.state(), &targets().state()});
    inputs_ = first_.inputs();
    if (second_) inputs_.insert(inputs_.end(), second_->inputs().begin(), second_->inputs().end());
    read_maps();
    if (!study.maps.any())
      states_.set_plan(PotentialPlan(study.potential, {facts_of(first_.state()), facts_of(targets().state())},
                                     study.options.temperature_K));
    if (reference_ != Reference::kOne) return;
    ComparedState source;
    source.role = "source";
    source.loaded = first_.state();
    states_.take_source(std::move(source), &source_map_);
    if (states_.plan().computes()) inputs_.push_back(states_.source().map_inputs.front());
  }

  /// Frames that have a source.
  FrameSet frames() const {
    const MovingState& moving = second_ ? *second_ : first_;
    FrameSet set;
    set.n_frames = moving.n_frames();
    set.incomplete = moving.incomplete();
    if (reference_ != Reference::kSame) return set;
    set.n_frames = std::min(set.n_frames, first_.n_frames());
    if (set.incomplete.empty()) set.incomplete = first_.incomplete();
    return set;
  }

  /// With the one source, where all frames have one.
  SeriesStates& states() { return states_; }

  ComparedState read(StateRole role, std::optional<int> frame, const SeriesStates& states,
                     const Progress& /*progress*/) override {
    return (role == StateRole::kSource ? first_ : targets()).read(frame.value(), role, states.plan());
  }
  const State& given(StateRole role) const override { return role == StateRole::kSource ? source_map_ : target_map_; }
  std::vector<InputFile> inputs(const SeriesStates& /*states*/) const override { return inputs_; }

 private:
  MovingStateOptions moving_options() const {
    return {study_.structure, study_.plugins, study_.potential, study_.maps.any()};
  }

  /// Frames from which the source's molecule comes.
  std::vector<std::string> source_files() const {
    if (reference_ == Reference::kSame) return study_.source_frames;
    return reference_ == Reference::kPrevious || study_.frames_of.empty() ? study_.frames : std::vector<std::string>();
  }

  MovingState& targets() { return second_ ? *second_ : first_; }

  void open_targets(const Progress& progress) {
    if (!study_.frames_of.empty()) {
      second_.emplace(moving_options(), StateRole::kTarget, study_.frames_of, 1, study_.frames, study_.options.input,
                      progress);
    } else if (reference_ == Reference::kSame) {
      second_.emplace(first_, StateRole::kTarget, study_.source, study_.frames);
    }
    if (reference_ != Reference::kSame || study_.request.frames != "all" || first_.n_frames() == second_->n_frames())
      return;
    throw InputError(
        "the trajectories have " + std::to_string(first_.n_frames()) + " and " + std::to_string(second_->n_frames()) +
        " frames; choose those of both: " + option("frames", "0:" + std::to_string(frames().n_frames - 1)));
  }

  void read_maps() {
    for (auto [role, map] : {std::pair("source_map", &source_map_), {"target_map", &target_map_}}) {
      read_given_map(*map);  // one for all frames
      if (map->map == nullptr) continue;
      inputs_.push_back(map->map_input);
      inputs_.back().role = role;
    }
  }

  const TrajectoryStudy& study_;
  Reference reference_;
  MovingState first_;                  // of the source
  std::optional<MovingState> second_;  // of the frames, where they are not the source's molecule
  State source_map_, target_map_;
  SeriesStates states_;
  std::vector<InputFile> inputs_;
};

SeriesDescription description_of(const TrajectoryStudy& study, const PotentialPlan& potential) {
  SeriesDescription run;
  run.files = study.frames;
  run.structure = study.structure;
  run.frames_of = study.frames_of;
  run.reference = reference_words(study);
  run.reference_files = study.source_frames;
  if (potential.computes()) {
    run.map = potential.in_words();
  } else {
    run.map = map_words(study.maps.of(false));
    run.reference_map = map_words(study.maps.of(true));
  }
  return run;
}

}  // namespace

const std::vector<OptionRow<TrajectoryStudy>>& trajectory_file_settings() {
  using Rows = RowsOf<TrajectoryStudy>;
  const std::string group = "Frames";
  static const std::vector<Rows::Row> all{
      Rows::choice_of<bool>(
          "reference", group, {{"source", false}, {"previous", true}},
          [](auto& o) -> auto& { return o.against_previous; },
          "Compare each frame with SOURCE, or with the frame before it"),
      Rows::file(
          "frames-of", group, [](auto& o) -> auto& { return o.frames_of; },
          "Structure or topology whose atoms, charges and radii FRAMES have, where they are not SOURCE's"),
      Rows::text(
          "plugins", group, [](auto& o) -> auto& { return o.plugins; }, kMolfileFolderHelp),
      Rows::count(
          "source-model", "Molecules", {1}, [](auto& o) -> auto& { return o.source_model; },
          "Model of a source file with several; with a topology as SOURCE, frame of the first trajectory")};
  return all;
}

void check_study(const TrajectoryStudy& study) {
  const bool has_own_source = !study.source_frames.empty();
  if (study.against_previous && (has_own_source || !study.frames_of.empty()))
    throw InputError(option(has_own_source ? "source-frames" : "frames-of") + " and " +
                     option("reference", "previous") + " exclude each other" +
                     (has_own_source ? "" : "; give the frames' own structure as SOURCE"));
  std::vector<std::string> inputs = study.frames;
  inputs.insert(inputs.end(), study.source_frames.begin(), study.source_frames.end());
  inputs.insert(inputs.end(), {study.source, study.frames_of, study.maps.source_map, study.maps.target_map});
  check_request(study.request, study.options, std::move(inputs), study.picture);
}

TrajectorySteps::TrajectorySteps(const TrajectoryRequest& request, TrajectoryPlan plan, SeriesDescription run,
                                 StepStates& given, SeriesStates& states)
    : given_(given), states_(states), has_one_source_(plan.against == Reference::kOne) {
  run_ = begin_trajectory(request, std::move(plan), std::move(run));
}

void TrajectorySteps::take_source(std::optional<int> frame, const Progress& progress) {
  states_.take_source(given_.read(StateRole::kSource, frame, states_, progress), &given_.given(StateRole::kSource));
}

void TrajectorySteps::take_one_source(const Progress& progress) {
  if (!has_one_source_ || states_.has_source()) return;
  take_source(std::nullopt, progress);
  run_->note_inputs(given_.inputs(states_));
}

StepInput TrajectorySteps::read(const TrajectoryStep& step, const Progress& progress) {
  if (step.source) take_source(step.source, progress);
  StepInput both =
      states_.step(given_.read(StateRole::kTarget, step.frame, states_, progress), given_.given(StateRole::kTarget));
  both.inputs = given_.inputs(states_);
  return both;
}

const SeriesRow* TrajectorySteps::step(Engine& engine, const Progress& progress) {
  take_one_source(progress);
  return run_->step(
      engine, [&] { return read(run_->next(), progress); }, progress);
}

void TrajectorySteps::finish(Engine& engine, const Progress& progress) {
  if (!run_->is_done() && run_->is_independent()) {
    take_one_source(progress);
    run_->finish(
        engine, states_.surface().size(), [&](const TrajectoryStep& step) { return read(step, progress); }, progress);
  }
  while (!run_->is_done()) step(engine, progress);
}

TrajectorySummary run_trajectory(const TrajectoryStudy& study, Engine& engine, const Progress& progress) {
  check_study(study);
  progress.report("read", 0.0);
  FileStates states(study, progress);
  TrajectoryPlan plan;
  plan.options = study.options;
  plan.against = study.reference();
  plan.reference = reference_words(study);
  plan.frames = parse_frames(study.request.frames, states.frames());
  plan.compared = parts_and_fields(plan.options);
  TrajectorySteps steps(study.request, std::move(plan), description_of(study, states.states().plan()), states,
                        states.states());
  TrajectoryRun& run = steps.run();
  if (study.tell && !run.warning().empty()) study.tell(run.warning());
  run.note_inputs(states.inputs(states.states()));
  steps.finish(engine, progress);
  return run.summary();
}

}  // namespace espdiff
