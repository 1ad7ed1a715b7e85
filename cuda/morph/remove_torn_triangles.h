// remove_torn_triangles.h: removes what has left the level set.
#pragma once

#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Removes triangles that have an unmatched vertex or are flipped. Vertices become unmatched if their normal is flipped
/// or no triangle remains at them. Where vertices wait, none flips.
void remove_torn_triangles(MovingSurface& surface);

}  // namespace espdiff::ESPDIFF_BACKEND
