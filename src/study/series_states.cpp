// series_states.cpp: maps, radii, region and patches of a series' states.
#include "study/series_states.h"

#include <utility>

#include "prepare/region.h"
#include "prepare/surface_radii.h"

namespace espdiff {

void SeriesStates::take_source(ComparedState state, const State* given) {
  if (given != nullptr) add_map(*given, plan_, options_.temperature_K, state);
  source_ = std::move(state);
  frame_ = std::make_shared<const ComparedState>();
  const Molecule& molecule = source_.loaded.molecule;
  source_.take_parts(source_parts(molecule, source_.whole(), molecule, source_.whole(), options_.input));
  Molecule surface = molecule;
  set_surface_radii({&surface}, options_.input.radii);
  surface_ = std::move(surface);
}

StepInput SeriesStates::step(ComparedState frame, const State& given) {
  add_map(given, plan_, options_.temperature_K, frame);
  const auto held = std::make_shared<ComparedState>(std::move(frame));
  set_frame_radii(surface_, held->loaded.molecule, options_.input.radii);
  frame_ = held;
  return {source_side(), held->side(), {}, &source_.loaded, &held->loaded, held};
}

}  // namespace espdiff
