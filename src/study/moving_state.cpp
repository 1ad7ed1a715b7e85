// moving_state.cpp: loads a state, and reads its frames.
#include "study/moving_state.h"

#include <utility>

#include "base/error.h"
#include "frames/frame_state.h"
#include "io/frames/open_structure.h"
#include "io/structures/structure_file.h"
#include "report/state_report.h"

namespace espdiff {

MovingState::MovingState(MovingStateOptions options, StateRole role, const std::string& topology, int model,
                         const std::vector<std::string>& files, const InputOptions& input, const Progress& progress)
    : options_(std::move(options)),
      role_(role),
      input_(input),
      progress_(progress),
      opener_(topology, options_.plugins, progress) {
  open(files);
  load(topology, model, files);
}

MovingState::MovingState(const MovingState& like, StateRole role, const std::string& topology,
                         const std::vector<std::string>& files)
    : options_(like.options_),
      role_(role),
      input_(like.input_),
      progress_(like.progress_),
      opener_(topology, options_.plugins, progress_),
      state_(like.state_) {
  open(files);
}

void MovingState::open(const std::vector<std::string>& files) {
  if (!files.empty()) frames_.emplace(files, [this](const std::string& path) { return opener_.open(path); });
}

void MovingState::load(const std::string& topology, int model, const std::vector<std::string>& files) {
  const bool is_topology = opener_.needs_coordinates();
  if (is_topology && files.empty())
    throw InputError(topology + ": is a topology without coordinates; give a structure first, and the topology as " +
                     option("topology"));
  // As VMD takes them: a topology, then a structure with the places of its atoms.
  const bool is_of_structure = is_topology && !has_coordinates_alone(files.front());
  if (is_of_structure) input_.both.topology = topology;
  // A trajectory that is open already is not read again.
  const auto structure = is_topology ? nullptr : open_structure(topology);
  // The frames' atoms are in the topology beside it, too.
  if (structure != nullptr && structure->needs_atoms() && input_.both.topology.empty())
    input_.both.topology = topology_beside(*structure, options_.structure);
  const StructureFile& file = is_topology ? *frames_->file_of_frame(0).first : *structure;
  StateRequest request{options_.structure, role_};
  request.structure.model = model;
  state_ = load_for(options_.potential, !options_.has_maps, file, request, input_, progress_);
  if (!is_topology) file.require_unchanged(opener_.sha256());
  const std::string name = to_string(role_);
  inputs_ = is_of_structure
                ? state_inputs(name, {name, files.front(), file.sha256()}, state_)
                : state_inputs(name, {name, topology, is_topology ? opener_.sha256() : file.sha256()}, state_);
  if (is_topology && !is_of_structure) inputs_.push_back({name + "_coordinates", files.front(), file.sha256()});
}

ComparedState MovingState::read(int number, StateRole role, const PotentialPlan& potential) {
  ComparedState state;
  state.role = to_string(role);
  state.loaded = load_frame_state(*frames_, number, options_.structure, state_, potential.takes_everything(), input_,
                                  progress_, role);
  return state;
}

}  // namespace espdiff
