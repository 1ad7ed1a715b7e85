// series_source.h: the source of a series, whose surface is made once, and the frames that are compared with it.
#pragma once

#include "base/molecule/input_options.h"
#include "study/state.h"

namespace espdiff {

/// A source, with the radii of its surface apart from those that its frames take.
class SeriesSource {
 public:
  /// Takes another source. @throws as set_surface_radii(), source_parts()
  void take(ComparedState state, const InputOptions& options);

  const ComparedState& state() const { return state_; }
  const LoadedState& loaded() const { return state_.loaded; }
  const Molecule& surface() const { return surface_; }
  /// Refers to this source.
  CompareInput side() const { return {&surface_, state_.map.get(), state_.make_map, state_.parts, state_.fields}; }
  /// A frame with the radii that its surface is made by. Refers to the frame. @throws as set_frame_radii()
  CompareInput frame(ComparedState& frame, const InputOptions& options) const;

 private:
  ComparedState state_;
  Molecule surface_;
};

}  // namespace espdiff
