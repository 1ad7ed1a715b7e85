// surface_error.h: the error that a solution still has at the solute's surface, where potentials are read.
#pragma once

#include <cstdint>

#include "cuda/potential/pb/multigrid/multigrid.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Estimates the error from what each cycle changes there. Changes fall evenly; if each is q times the one before, the
/// sum of all that follow is q / (1 - q) times the last. Over the residual this has the advantage that it does not
/// depend on how much the charges' potentials cancel at the surface.
class SurfaceError {
 public:
  /// Finds the grid points at the surface: those among whose six faces one dielectric is at least twice another.
  /// @param on_grid with its arrays; not needed later
  explicit SurfaceError(const GridOperator& on_grid);
  /// Whether there are such points.
  bool is_known() const { return !points_.empty(); }
  /// After a cycle's x += alpha p. @returns the error's rms at the surface relative to that of x
  double after_cycle(float alpha, const Buffer<float>& p, const Buffer<float>& x);

 private:
  Buffer<std::uint32_t> points_;
  double last_ = 0, before_last_ = 0;  ///< relative changes; 0 for none
};

}  // namespace espdiff::ESPDIFF_BACKEND
