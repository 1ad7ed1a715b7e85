// series_state.h: what a series passes from one step to the next, so that it can be saved.
#pragma once

#include <optional>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// State that a series passes from one step to the next, in the source's principal frame. Angstrom.
struct SeriesState {
  std::vector<Vec3f> mapped;  ///< [vertex] the last step's mapped surface
  std::vector<Vec3d> target;  ///< [atom of the source] position of its paired atom in the last target; NaN if unpaired

  /// For the morph, whose mesh grows.
  struct Morph {
    std::vector<Vec3f> source;  ///< [vertex] position on the source
    std::vector<Triangle> triangles;
    std::vector<float> unmatched;    ///< [triangle] nonzero: lost in this step or an earlier one
    std::vector<float> path_length;  ///< [vertex] path length so far
    Molecule target;                 ///< the last target
    /// Unmatched fractions of the source's area: on the last target, and on the last target that was mapped from the
    /// source itself.
    double unmatched_share = 0, unmatched_share_at_start = 0;
  };
  std::optional<Morph> morph;  ///< empty for the method deform
};

}  // namespace espdiff
