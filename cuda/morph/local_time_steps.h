// local_time_steps.h: local time stepping (multirate integration): where nothing near a vertex moves far or fades, its
// flow is evaluated in every second, fourth or eighth step of the morph only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cuda/morph/moving_atoms.h"
#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Which intervals are too long near an atom.
struct LocalTimeSteps {
  std::vector<float> displacements_A;  ///< [atom] in a step; one that fades counts as if it moved
  std::uint32_t longest = 1;           ///< number of steps of the longest interval, a power of two
  float max_displacement_A = 0;        ///< during an interval, of a vertex or of an atom near it
};

/// Marks the vertices whose interval has not ended at `step` as waiting; the others keep their flow as the previous
/// one.
/// @param all whether all intervals end here
void end_intervals(MovingSurface& surface, std::uint32_t step, bool all);

/// Begins the next interval of each vertex that does not wait: the longest in which no atom can come near that moves
/// too far. An interval of n steps begins at multiples of n, and neighbours share theirs, so that they are evaluated
/// together.
/// @param dt of one step
void begin_intervals(MovingSurface& surface, const LocalTimeSteps& local, const MovingAtoms& atoms, std::uint32_t step,
                     float dt);

/// Marks the vertices that are where they were after the last return as waiting.
/// @param settled [vertex] positions then; vertices that were added since do not wait
void wait_where_settled(MovingSurface& surface, const Buffer<Vec4f>& settled);

}  // namespace espdiff::ESPDIFF_BACKEND
