// orientation.h: chooses the viewing direction, so that pictures are large and show the coloured side.
#pragma once

#include <vector>

#include "base/vector.h"

namespace espdiff {

/// An orthonormal frame of the picture and the extent of the surface in it.
struct Orientation {
  Vec3d centre{};  ///< middle of the surface in this frame, Angstrom
  Vec3d right{1, 0, 0}, up{0, 1, 0}, toward_viewer{0, 0, 1};
  double half_height_A = 0;  ///< farthest vertex along `up`
  double half_width_A = 0;   ///< farthest vertex across `up`, seen from any of the views
  double radius_A = 0;       ///< farthest vertex from the centre
};

/// Principal axes: the shortest toward the viewer, the longest across the picture (vertical if `upright`). The front is
/// the side whose vertices have the larger mean |value|. `up` points to the file's +z (or +y, +x if that is across), so
/// that the same molecule is always the same way up.
/// @param positions [vertex] Angstrom, not empty
/// @param values    [vertex] NaN counts as 0
/// @param n_views   views around `up`, for half_width_A: one or two use only front and back
Orientation choose_orientation(const std::vector<Vec3d>& positions, const std::vector<float>& values, bool upright,
                               int n_views);

}  // namespace espdiff
