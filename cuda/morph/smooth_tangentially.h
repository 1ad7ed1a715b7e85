// smooth_tangentially.h: smooths the surface along itself.
#pragma once

#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Smooths the vertices that do not wait and whose triangles have a much worse shape than on the source: moves them
/// toward the mean of their ring, along the surface, by at most a third of the smallest altitude, so that no triangle
/// flips.
void smooth_tangentially(MovingSurface& surface);

}  // namespace espdiff::ESPDIFF_BACKEND
