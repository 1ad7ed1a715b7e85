// series_states.cpp: maps, radii, region and patches of a series' states.
#include "study/series_states.h"

#include <utility>

#include "prepare/region.h"
#include "prepare/surface_radii.h"

namespace espdiff {

void SeriesStates::take_source(ComparedState state, const State* given) {
  if (given != nullptr) add_map(*given, plan_, options_.temperature_K, state);
  source_ = std::move(state);
  frame_ = {};
  const Molecule& molecule = source_.loaded.molecule;
  source_.take_parts(source_parts(molecule, source_.whole(), molecule, source_.whole(), options_.input));
  Molecule surface = molecule;
  set_surface_radii({&surface}, options_.input.radii);
  surface_ = std::move(surface);
}

StepInput SeriesStates::step(ComparedState frame, const State& given) {
  add_map(given, plan_, options_.temperature_K, frame);
  frame_ = std::move(frame);
  set_frame_radii(surface_, frame_.loaded.molecule, options_.input.radii);
  return {source_side(), frame_.side(), {}, &source_.loaded, &frame_.loaded};
}

}  // namespace espdiff
