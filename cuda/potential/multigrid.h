// multigrid.h: the discrete operator -div(eps grad) + kappa^2 on a grid, and a multigrid V-cycle as an
// approximate inverse.
//
// Finite volumes around the points of a cubic lattice, Dirichlet values on its border (Nicholls and Honig, J. Comput.
// Chem. 12, 435 (1991), among many):
//
//     (A x)_p = sum over the six faces eps_f (x_p - x_q) + k_p x_p,    k_p = h^2 kappa_bar^2 lambda_p
//
// V(1,1): Gauss-Seidel, red then black before, black then red after, so that the cycle is symmetric and serves
// conjugate gradients as a preconditioner. Coarse grids take every other point. Restriction is the transpose of
// trilinear interpolation.
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

/// Adds the six faces' dielectrics to the diagonal, which is k before.
void add_faces_to_diagonal(GridOperator& on_grid);
/// y = A x at inner points, from x with its border. The border of y is not changed.
void apply_operator(const GridOperator& on_grid, const Buffer<float>& x, Buffer<float>& y);
/// r = b - A (x + low) at inner points, summed in double precision.
void exact_residual(const GridOperator& on_grid, const Buffer<float>& x, const Buffer<float>& low,
                    const Buffer<float>& b, Buffer<float>& r);
/// Sets the inner points to zero; the border keeps its values.
void clear_inner(const GridSize& size, Buffer<float>& x);
/// Moves from `low` to x what single precision holds: x + low stays the same number, to about 14 digits.
void add_parts(Buffer<float>& x, Buffer<float>& low);

class Multigrid {
 public:
  /// @param finest must outlive this object
  explicit Multigrid(const GridOperator& finest);
  /// z = B r with a symmetric B that approximates the inverse of A; zero on the border.
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
