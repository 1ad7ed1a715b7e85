// follow_level_set.h: moves the surface with the flow, and back to the level set.
#pragma once

#include "cuda/morph/moving_atoms.h"
#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Moves every vertex with the flow.
void advance(MovingSurface& surface, float dt);

/// Returns vertices to the level set by Newton's method and evaluates the flow there; vertices that cannot return
/// become unmatched.
/// @param settled  [vertex] positions after an earlier call with the same atoms: vertices that are still there keep
///                 place and flow; empty, or for vertices that were added since, none do
void return_to_level_set(MovingSurface& surface, const MovingAtoms& atoms, float isovalue,
                         const Buffer<Vec4f>& settled = {});

/// The general form, in which each vertex takes all its steps at once; gives the same bits.
void return_vertex_by_vertex(MovingSurface& surface, const MovingAtoms& atoms, float isovalue,
                             const Buffer<Vec4f>& settled = {});

}  // namespace espdiff::ESPDIFF_BACKEND
