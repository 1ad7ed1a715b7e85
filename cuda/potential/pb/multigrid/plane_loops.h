// plane_loops.h: the steps of a multigrid cycle on one plane of a grid (CPU); see plane_sweeps.h.
//
// A plane is given by its first point. Steps write the inner points of some of its rows.
#pragma once

#if !defined(ESPDIFF_BACKEND_CUDA)

#include "cuda/potential/pb/multigrid/operator_rows.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Three neighbouring planes, or their rows.
struct Planes {
  const float* below;
  const float* here;
  const float* above;

  Planes row(std::size_t first) const { return {below + first, here + first, above + first}; }
};

/// x of the plane's red points by their own equation, the others zero: half a sweep from zero.
void start_plane(OperatorRows& a, const GridSize& size, int k, RowRange rows, const float* b, float* x);
/// Half a sweep: `out` is x with the colour's points renewed. Not in place: a vector would be loaded across the one
/// just stored, which stalls.
void sweep_plane(OperatorRows& a, const GridSize& size, int k, RowRange rows, int colour, const float* b,
                 const Planes& x, float* out);
/// The residual after a red and a black half sweep from zero: that of black points is zero.
void residual_plane(OperatorRows& a, const GridSize& size, int k, RowRange rows, const Planes& x, float* r);
/// y = A x.
void apply_plane(OperatorRows& a, const GridSize& size, int k, RowRange rows, Products products, const Planes& x,
                 float* y);
/// r -= A (x + low), summed in double precision: float products are exact there. @param low null for zero
void subtract_exactly_plane(OperatorRows& a, const GridSize& size, int k, const float* x, const float* low, float* r);

/// Rows of the coarse grid of a plane of restrict_to(); see there. @param line [nx] is overwritten
void restrict_plane(const GridSize& fine, const Planes& r, const GridSize& coarse, RowRange rows, float* line,
                    float* b);
/// A plane of add_interpolated(): out = x + the correction between coarse planes `below` and `above`.
void interpolate_plane(const GridSize& coarse, const float* below, const float* above, const GridSize& fine,
                       RowRange rows, const float* x, float* line, float* out);

/// p = z + beta from.
void turn_plane(float beta, const float* z, const float* from, std::size_t n, float* p);
/// sum a_i b_i, in lanes whose number does not depend on the processor.
double dot_run(const float* a, const float* b, std::size_t n);
/// Adds a_i b_i of [first, last) to lane i % kLanes. One run after the other gives the lanes of a single one.
void add_products(const float* a, const float* b, std::size_t first, std::size_t last, LaneSums& sums);
/// x += alpha p, r -= alpha q.
void advance_run(float alpha, const float* p, const float* q, std::size_t n, float* x, float* r);
/// r -= alpha q.
void subtract_scaled_run(float alpha, const float* q, std::size_t n, float* r);

}  // namespace espdiff::ESPDIFF_BACKEND

#endif
