// follow_level_set.h: moves the surface with the flow, and back to the level set.
#pragma once

#include "cuda/morph/moving_atoms.h"
#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Moves every vertex with its flow to `step`, dt after the step before.
void advance(MovingSurface& surface, std::uint32_t step, float dt);

/// Returns the vertices that do not wait to the level set by Newton's method and evaluates the flow there; vertices
/// that cannot return become unmatched.
void return_to_level_set(MovingSurface& surface, const MovingAtoms& atoms, float isovalue);

/// The general form, in which each vertex takes all its steps at once; gives the same bits.
void return_vertex_by_vertex(MovingSurface& surface, const MovingAtoms& atoms, float isovalue);

}  // namespace espdiff::ESPDIFF_BACKEND
