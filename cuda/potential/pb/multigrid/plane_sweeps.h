// plane_sweeps.h: passes over a grid that do several steps of a multigrid cycle at once, plane after plane (CPU).
//
// A step alone reads the operator's four arrays from memory, which takes longer than its arithmetic. In a pass, the
// next step follows a plane or two behind, while these planes are in the cache. Threads have ranges of planes; what a
// thread needs of its neighbours' planes it computes again, in buffers of its own. Large planes do not fit into the
// cache: they are swept in strips of rows, each strip through all of a thread's planes, with the same repetition at its
// edges. So the bits are those of the single steps (Multigrid::precondition_by_points), at any number of threads.
#pragma once

#if !defined(ESPDIFF_BACKEND_CUDA)

#include <vector>

#include "cuda/potential/pb/multigrid/multigrid.h"

namespace espdiff::ESPDIFF_BACKEND {

class PlaneSweeps {
 public:
  /// Buffers for grids of at most this size.
  explicit PlaneSweeps(const GridSize& largest);

  /// x = a red, then a black half sweep from zero for A x = b; coarse_b = the restricted residual.
  void smooth_and_restrict(const GridOperator& a, const Buffer<float>& b, Buffer<float>& x, const GridSize& coarse,
                           Buffer<float>& coarse_b);
  /// x += the interpolated correction, then a black, then a red half sweep. @returns b . x
  double correct_and_smooth(const GridOperator& a, const Buffer<float>& b, const GridSize& coarse,
                            const Buffer<float>& correction, Buffer<float>& x);
  /// p = z + beta p, then z = A p. @returns p . A p
  double turn_and_apply(const GridOperator& a, float beta, Products products, Buffer<float>& z, Buffer<float>& p);

 private:
  /// Planes of one thread.
  struct Own {
    Buffer<float> coefficients;                                     ///< see OperatorRows
    Buffer<float> zero, x[3], black[3], r[3], halo[4], row, saved;  ///< `black`: x after the black half sweep
  };
  std::vector<Own> own_;
};

/// subtract_exactly() of a packed operator.
void subtract_exactly_by_rows(const GridOperator& a, const Buffer<float>& x, const Buffer<float>& low,
                              Buffer<float>& r);

/// x += alpha p, r -= alpha q. @returns r . r
/// @param p, x [point of r], or null where there is no x
double advance_by_runs(float alpha, const float* p, const float* q, float* x, Buffer<float>& r);

}  // namespace espdiff::ESPDIFF_BACKEND

#endif
