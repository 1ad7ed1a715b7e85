// series_states.h: the two states of each step of a series: a source, whose surface is made once, and a frame.
#pragma once

#include <memory>

#include "options/options.h"
#include "study/state.h"
#include "trajectory/trajectory.h"

namespace espdiff {

/// A source, with the radii of its surface apart from those that its frames take, and the frame that is compared with
/// it.
class SeriesStates {
 public:
  /// Keeps a reference.
  explicit SeriesStates(const CompareOptions& options) : options_(options) {}

  /// How potentials are computed of states that have none of their own. Without a plan none are.
  void set_plan(PotentialPlan plan) { plan_ = std::move(plan); }
  const PotentialPlan& plan() const { return plan_; }
  /// Takes another source.
  /// @param given the state with its map; null where `state` has its map already
  /// @throws as add_map(), set_surface_radii(), source_parts()
  void take_source(ComparedState state, const State* given);
  /// The sides of the source and this frame, which stay as long as the step.
  /// @param given has the frame's map. @throws as add_map(), set_frame_radii()
  StepInput step(ComparedState frame, const State& given);

  bool has_source() const { return surface_.size() > 0; }
  const ComparedState& source() const { return source_; }
  /// The last one of step(); empty before the first one of a source.
  const ComparedState& frame() const { return *frame_; }
  /// The source's molecule with the radii of its surface.
  const Molecule& surface() const { return surface_; }
  /// The source's side of a comparison; refers to this.
  CompareInput source_side() const {
    return {&surface_, source_.map.get(), source_.make_map, source_.parts, source_.fields};
  }

 private:
  const CompareOptions& options_;
  PotentialPlan plan_;
  ComparedState source_;
  std::shared_ptr<const ComparedState> frame_ = std::make_shared<const ComparedState>();
  Molecule surface_;
};

}  // namespace espdiff
