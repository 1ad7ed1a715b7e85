// series_source.cpp: radii, region and patches of a series.
#include "study/series_source.h"

#include <utility>

#include "prepare/region.h"
#include "prepare/surface_radii.h"

namespace espdiff {

void SeriesSource::take(ComparedState state, const InputOptions& options) {
  state_ = std::move(state);
  const Molecule& molecule = state_.loaded.molecule;
  state_.take_parts(source_parts(molecule, state_.whole(), molecule, state_.whole(), options));
  surface_ = molecule;
  set_surface_radii({&surface_}, options.radii);
}

CompareInput SeriesSource::frame(ComparedState& frame, const InputOptions& options) const {
  set_frame_radii(surface_, frame.loaded.molecule, options.radii);
  return frame.side();
}

}  // namespace espdiff
