// trajectory_sides.cpp: loads the states, and reads their frames.
#include "cli/trajectory_sides.h"

#include <algorithm>

#include "base/error.h"
#include "frames/frame_state.h"
#include "io/frames/molfile_plugins.h"
#include "io/frames/open_structure.h"
#include "io/structures/structure_file.h"
#include "options/options.h"
#include "report/state_report.h"

namespace espdiff::cli {

Reference reference_of(const TrajectoryArguments& a) {
  if (!a.source_frames.empty()) return Reference::kSame;
  return a.reference == "previous" ? Reference::kPrevious : Reference::kOne;
}

MovingState::MovingState(const TrajectoryArguments& a, StateRole role, const std::string& topology,
                         const std::vector<std::string>& files, const InputOptions& options, const Progress& progress)
    : a_(a), role_(role), options_(options), progress_(progress), opener_(topology, a.plugins, progress) {
  open(files);
  load(topology, files);
}

MovingState::MovingState(const MovingState& like, StateRole role, const std::string& topology,
                         const std::vector<std::string>& files)
    : a_(like.a_),
      role_(role),
      options_(like.options_),
      progress_(like.progress_),
      opener_(topology, a_.plugins, progress_),
      state_(like.state_) {
  open(files);
}

void MovingState::open(const std::vector<std::string>& files) {
  if (!files.empty()) frames_.emplace(files, [this](const std::string& path) { return opener_.open(path); });
}

void MovingState::load(const std::string& topology, const std::vector<std::string>& files) {
  const bool is_topology = opener_.needs_coordinates();
  if (is_topology && (files.empty() || !needs_molfile_reader(files.front())))
    throw InputError(topology + ": is a topology without coordinates" +
                     (files.empty() ? "" : ", and " + files.front() + " is no trajectory") +
                     "; give a structure first, and the topology as " + option("topology"));
  // A trajectory that is open already is not read again.
  const auto structure = is_topology ? nullptr : open_structure(topology);
  const StructureFile& file = is_topology ? *frames_->file_of_frame(0).first : *structure;
  StateRequest request{a_.structure, role_};
  if (role_ == StateRole::kSource) request.structure.model = a_.source_model;
  state_ = load_for(a_.maps, !has_given_maps(a_.maps), file, request, options_, progress_);
  if (!is_topology) file.require_unchanged(opener_.sha256());
  const std::string name = to_string(role_);
  inputs_ = state_inputs(name, {name, topology, is_topology ? opener_.sha256() : file.sha256()}, state_);
  if (is_topology) inputs_.push_back({name + "_coordinates", files.front(), file.sha256()});
}

ComparedState MovingState::read(int number, StateRole role, const PotentialPlan& potential) {
  ComparedState state;
  state.role = to_string(role);
  state.loaded =
      load_frame_state(*frames_, number, a_.structure, state_, potential.takes_everything(), options_, progress_, role);
  return state;
}

namespace {

/// Frames from which the source's molecule comes.
std::vector<std::string> source_files(const TrajectoryArguments& a) {
  switch (reference_of(a)) {
    case Reference::kSame: return a.source_frames;
    case Reference::kPrevious: return a.targets;
    case Reference::kOne: break;
  }
  return a.frames_of.empty() ? a.targets : std::vector<std::string>();
}

}  // namespace

TrajectorySides::TrajectorySides(const TrajectoryArguments& a, const CompareOptions& options, const Progress& progress)
    : a_(a),
      options_(options.input),
      reference_(reference_of(a)),
      first_(a, StateRole::kSource, a.source, source_files(a), options.input, progress) {
  open_targets(progress);
  const LoadedState& target = targets().state();
  check_left_out(options_, {&first_.state(), &target});
  inputs_ = first_.inputs();
  if (second_) inputs_.insert(inputs_.end(), second_->inputs().begin(), second_->inputs().end());
  for (State* map : {&source_map_, &target_map_}) {
    const bool is_source = map == &source_map_;
    *map = with_given_map(a.maps, is_source);
    read_given_map(*map);  // one for all frames
    if (map->map == nullptr) continue;
    inputs_.push_back(map->map_input);
    inputs_.back().role = is_source ? "source_map" : "target_map";
  }
  temperature_K_ = options.temperature_K;
  if (!has_given_maps(a.maps))
    plan_ = PotentialPlan(a.maps, {facts_of(first_.state()), facts_of(target)}, options.temperature_K);
  if (reference_ != Reference::kOne) return;
  ComparedState source;
  source.role = "source";
  source.loaded = first_.state();
  use_source(std::move(source));
  if (plan_.computes()) inputs_.push_back(source_.state().map_inputs.front());
}

void TrajectorySides::open_targets(const Progress& progress) {
  if (!a_.frames_of.empty()) {
    second_.emplace(a_, StateRole::kTarget, a_.frames_of, a_.targets, options_, progress);
  } else if (reference_ == Reference::kSame) {
    second_.emplace(first_, StateRole::kTarget, a_.source, a_.targets);
  }
  if (reference_ != Reference::kSame || a_.request.frames != "all" || first_.n_frames() == second_->n_frames()) return;
  throw InputError("the trajectories have " + std::to_string(first_.n_frames()) + " and " +
                   std::to_string(second_->n_frames()) +
                   " frames; choose those of both: " + option("frames", "0:" + std::to_string(frames().n_frames - 1)));
}

FrameSet TrajectorySides::frames() const {
  FrameSet set;
  set.n_frames = targets().n_frames();
  set.incomplete = targets().incomplete();
  if (reference_ != Reference::kSame) return set;
  set.n_frames = std::min(set.n_frames, first_.n_frames());
  if (set.incomplete.empty()) set.incomplete = first_.incomplete();
  return set;
}

StepInput TrajectorySides::step(const TrajectoryStep& step) {
  if (step.source) use_source(first_.read(*step.source, StateRole::kSource, plan_));
  target_ = targets().read(step.frame, StateRole::kTarget, plan_);
  add_map(target_map_, plan_, temperature_K_, target_);
  return {source_.side(), source_.frame(target_, options_), {}, &source_.loaded(), &target_.loaded};
}

void TrajectorySides::use_source(ComparedState source) {
  add_map(source_map_, plan_, temperature_K_, source);
  source_.take(std::move(source), options_);
}

}  // namespace espdiff::cli
