// multigrid.h: the discrete operator -div(eps grad) + kappa^2 on a grid, and a multigrid V-cycle that nearly inverts
// it.
//
// Finite volumes around the points of a cubic lattice, Dirichlet values on its border (Nicholls and Honig, J. Comput.
// Chem. 12, 435 (1991), among many):
//
//     (A x)_p = sum over the six faces eps_f (x_p - x_q) + k_p x_p,    k_p = h^2 kappa_bar^2 lambda_p
//
// V(1,1): Gauss-Seidel, red then black before, black then red after, so that the cycle is symmetric and serves
// conjugate gradients as a preconditioner. Coarse grids take every other point, of any number of points; restriction is
// the transpose of trilinear interpolation.
#pragma once

#include <vector>

#include "cuda/potential/grid_kernels.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The operator's coefficients on one grid.
struct GridOperator {
  GridSize size;
  Buffer<float> ex, ey, ez;  ///< [point] dielectric of the face towards the next point along x, y, z
  Buffer<float> diagonal;    ///< [point] sum of the six faces' and k
};

/// Sets operator_.diagonal, at first k, to its sum with the six faces' dielectrics.
void add_faces_to_diagonal(GridOperator& on_grid);
/// y = A x at inner points; the border of y is left alone. `x` counts with its border.
void apply_operator(const GridOperator& on_grid, const Buffer<float>& x, Buffer<float>& y);
/// r = b - A (x + low) at inner points, summed in double precision.
void exact_residual(const GridOperator& on_grid, const Buffer<float>& x, const Buffer<float>& low,
                    const Buffer<float>& b, Buffer<float>& r);
/// Moves from `low` to x what single precision holds: x + low stays the same number, to about 14 digits.
void add_parts(Buffer<float>& x, Buffer<float>& low);

class Multigrid {
 public:
  /// @param finest outlives this
  explicit Multigrid(const GridOperator& finest);
  /// z = B r, B symmetric and nearly the inverse of A; zero on the border.
  /// @param scratch of the finest grid's size
  void precondition(const Buffer<float>& r, Buffer<float>& z, Buffer<float>& scratch);
  int n_levels() const { return static_cast<int>(levels_.size()) + 1; }
  /// Bytes that the coarse grids take for each point of the finest.
  static constexpr double kBytesPerPoint = 7.0 * 4.0 / 7.0;

 private:
  struct Level {
    GridOperator on_grid;
    Buffer<float> x, b, r;
  };
  void cycle(std::size_t level, const GridOperator& on_grid, const Buffer<float>& b, Buffer<float>& x,
             Buffer<float>& r);

  const GridOperator& finest_;
  std::vector<Level> levels_;
};

}  // namespace espdiff::ESPDIFF_BACKEND
