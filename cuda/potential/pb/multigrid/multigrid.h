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
// trilinear interpolation. After the first black half sweep the residual of black points is zero. On the CPU the steps
// of a cycle run in passes (plane_sweeps.h), on a device one after the other; the bits of z are the same.
#pragma once

#include <memory>
#include <vector>

#include "cuda/potential/grid_kernels.h"

namespace espdiff::ESPDIFF_BACKEND {

class PackedOperator;

/// How the terms of A x are added up before they are rounded to single precision: in single precision, or in double,
/// where float products are exact. The terms are a hundred times as large as their sum where x is smooth.
enum class Products { kRounded, kExact };

/// The operator's coefficients on one grid.
struct CoefficientBuffers {
  Buffer<float> ex, ey, ez;  ///< [point] dielectric of the face towards the next point along x, y, z
  Buffer<float> diagonal;    ///< [point] sum of the six faces' and k
};

/// The operator on one grid.
struct GridOperator : CoefficientBuffers {
  GridSize size;
  /// Instead of arrays: of the finest grid's four, or of a coarse grid's faces.
  std::shared_ptr<const PackedOperator> packed;
};

/// Adds the six faces' dielectrics to the diagonal, which is k before. With packed coefficients, which need no
/// diagonal, it gives that one up instead and holds them. On a device, where kernels read arrays, they are not held.
void add_faces_to_diagonal(GridOperator& on_grid, std::shared_ptr<const PackedOperator> packed = nullptr);
/// Gives up the arrays of a grid that holds packed coefficients, for other uses of their memory. Only after the coarse
/// grids are made. Without packed ones the arrays stay, and what returns is empty.
CoefficientBuffers spare_arrays(GridOperator& on_grid);
/// y = A x at inner points, from x with its border. The border of y is not changed.
void apply_operator(const GridOperator& on_grid, const Buffer<float>& x, Buffer<float>& y,
                    Products products = Products::kRounded);
/// r -= A (x + low) at inner points, summed in double precision.
/// @param low no elements for zero
void subtract_exactly(const GridOperator& on_grid, const Buffer<float>& x, const Buffer<float>& low, Buffer<float>& r);
/// Sets the inner points to zero; the border keeps its values.
void clear_inner(const GridSize& size, Buffer<float>& x);
/// Moves from `low` to x what single precision holds: x + low stays the same number, to about 14 digits.
void add_parts(Buffer<float>& x, Buffer<float>& low);

/// Restriction is the transpose of trilinear interpolation, first across a row, then along it; half of it, which
/// belongs to the doubled spacing. Weights of a point's row and its eight neighbours, below, in and above its plane.
ESPDIFF_INLINE float across_weighted(const float* low, const float* mid, const float* high, std::size_t row) {
  const float corners = (*(low - row) + low[row]) + (*(high - row) + high[row]);
  const float sides = (low[0] + high[0]) + (*(mid - row) + mid[row]);
  return mid[0] + (0.5F * sides + 0.25F * corners);
}
ESPDIFF_INLINE float along_weighted(float before, float here, float after) {
  return 0.5F * (here + 0.5F * (before + after));
}

class PlaneSweeps;

class Multigrid {
 public:
  /// @param finest with the arrays of its faces; must outlive this object
  /// @param fewest_packed points of a coarse grid whose faces are packed if the finest grid's coefficients are; smaller
  ///                      arrays stay in the caches, where reading them takes less time than unpacking (CPU)
  explicit Multigrid(const GridOperator& finest, std::size_t fewest_packed = std::size_t{1} << 20);
  ~Multigrid();
  /// z = B r with a symmetric B that approximates the inverse of A. @returns r . z
  /// @param r, z zero on the border
  double precondition(const Buffer<float>& r, Buffer<float>& z);
  /// The same z, each step by itself (device).
  void precondition_by_points(const Buffer<float>& r, Buffer<float>& z);
  /// p = z + beta p, then z = A p. @returns p . A p
  double turn_and_apply(float beta, Buffer<float>& z, Buffer<float>& p, Products products = Products::kRounded);
  int n_levels() const { return static_cast<int>(levels_.size()) + 1; }
  /// Bytes for each point of the finest grid, at most: a residual there (on a device alone), and the coarse grids.
  static constexpr double kBytesPerPoint = 4 + 7.0 * 4.0 / 7.0;

 private:
  struct Level {
    GridOperator on_grid;
    Buffer<float> x, b, r;  ///< r of precondition_by_points() alone
  };
  void cycle_by_points(std::size_t depth, const GridOperator& a, const Buffer<float>& b, Buffer<float>& x,
                       Buffer<float>& r);

  const GridOperator& finest_;
  std::vector<Level> levels_;
  Buffer<float> residual_;  ///< of the finest grid, as Level::r
#if !defined(ESPDIFF_BACKEND_CUDA)
  void pack_coarse_faces(std::size_t fewest_points);
  double cycle_by_planes(std::size_t depth, const GridOperator& a, const Buffer<float>& b, Buffer<float>& x);
  std::unique_ptr<PlaneSweeps> sweeps_;
#endif
};

/// sum_i a_i b_i, in double precision, the same bits at any number of threads.
double dot_product(const Buffer<float>& a, const Buffer<float>& b);
/// x += alpha p, r -= alpha q. @returns r . r
double advance(float alpha, const Buffer<float>& p, const Buffer<float>& q, Buffer<float>& x, Buffer<float>& r);
/// r -= alpha q. @returns r . r
double subtract_scaled(float alpha, const Buffer<float>& q, Buffer<float>& r);

}  // namespace espdiff::ESPDIFF_BACKEND
