// local_time_steps.h: local time stepping (multirate integration): where nothing near a vertex moves far or fades, its
// flow is evaluated in every second, fourth or eighth step of the morph only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cuda/morph/moving_atoms.h"
#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {

/// For each cell of a grid, the intervals that are too long there. Kernel view.
struct IntervalGridView {
  const std::uint8_t* too_long;  ///< [cell, x fastest] bit b: an interval of 2^(b+1) steps
  int size[3];
  Vec3f origin;
  float cell;              ///< edge of a cell, Angstrom
  std::uint32_t longest;   ///< number of steps of the longest interval anywhere
  float max_displacement;  ///< of a vertex during an interval, Angstrom
};

/// The grid at one time.
struct IntervalGrid {
  Buffer<std::uint8_t> too_long;
  std::array<int, 3> size{};
  Vec3f origin{};
  float cell = 0;
  std::uint32_t longest = 1;
  float max_displacement = 0;

  IntervalGridView view() const;
};

/// Intervals that hold until an atom which moves or fades too far during them can reach a place.
class LocalTimeSteps {
 public:
  /// @param displacements_A    [atom] in a step; one that fades counts as if it moved
  /// @param longest            number of steps of the longest interval, a power of two; 1 switches local steps off
  /// @param max_displacement_A of an atom near a vertex, or of the vertex, during an interval
  LocalTimeSteps(std::vector<float> displacements_A, std::uint32_t longest, float max_displacement_A);

  IntervalGrid at(const MovingAtoms& atoms) const;

 private:
  std::vector<float> displacements_A_;
  std::uint32_t longest_;
  float max_displacement_A_;
};

/// Marks the vertices whose interval has not ended at `step` as waiting; the others keep their flow as the previous
/// one.
/// @param all whether all intervals end here
void end_intervals(MovingSurface& surface, std::uint32_t step, bool all);

/// Begins the next interval of each vertex that does not wait. An interval of n steps begins at multiples of n, so that
/// neighbours are evaluated together.
/// @param dt of one step
void begin_intervals(MovingSurface& surface, const IntervalGrid& grid, std::uint32_t step, float dt);

/// Marks the vertices that are where they were after the last return as waiting.
/// @param settled [vertex] positions then; vertices that were added since do not wait
void wait_where_settled(MovingSurface& surface, const Buffer<Vec4f>& settled);

}  // namespace espdiff::ESPDIFF_BACKEND
