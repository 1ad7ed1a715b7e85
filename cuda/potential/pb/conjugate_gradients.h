// conjugate_gradients.h: A x = b on a grid by conjugate gradients with a multigrid cycle as preconditioner.
#pragma once

#include <functional>
#include <utility>

#include "cuda/potential/pb/multigrid/multigrid.h"
#include "cuda/potential/pb/surface_error.h"

namespace espdiff::ESPDIFF_BACKEND {

struct SolverOptions {
  double tolerance = 1e-6;  ///< of the error at the surface, where one is given; otherwise of |b - A x| / norm
  double norm = 1;          ///< residuals are relative to it
  int max_cycles = 100;
  bool keeps_start = false;  ///< the start stays also where its residual is above that of zero
};

struct SolverReport {
  double start_residual = 0;     ///< of the start, relative
  double relative_residual = 0;  ///< computed from b - A x at the end, not carried along
  double surface_error = 0;      ///< estimated, relative; the residual without a surface
  int cycles = 0;
  bool converged = false;
};

/// The solver's arrays beside x; [point] each, zero on the border.
struct SolverWork {
  explicit SolverWork(std::size_t n_points) : SolverWork(n_points, {}) {}
  /// In the memory of arrays that are not needed any more, such as those of spare_arrays().
  SolverWork(std::size_t n_points, CoefficientBuffers&& spare)
      : r(std::move(spare.ex)), p(std::move(spare.ey)), z(std::move(spare.ez)) {
    for (Buffer<float>* values : {&r, &p, &z}) values->assign(n_points, 0.0F);
  }
  Buffer<float> r, p, z;
};

/// Writes b, zero on the border.
using RightHandSide = std::function<void(Buffer<float>& b)>;

/// Arrays are in single precision, sums in double. Conjugate gradients update the residual by recursion, and that one
/// drifts from the true residual. When the recursion has converged, the true residual is computed; the iteration
/// restarts from it where it is too large. Such a hybrid is robust in single precision where multigrid alone is not (Qi
/// and Luo, J. Chem. Inf. Model. 59, 409 (2019)).
///
/// Rounding x to single precision alone can leave a residual above the tolerance. So x gets a second part after a
/// restart, which takes the corrections (iterative refinement), and true residuals are computed in double precision
/// from both. The caller gets their sum, rounded once.
///
/// With a surface the iteration ends when the error there is small enough, and a true residual is too large if it is
/// more than twice the recursion's.
/// @param b     called for each true residual, so that no array holds it meanwhile
/// @param x     [point] start and result; its border has the Dirichlet values. A start with a residual above 1, worse
///              than zero, is replaced by zero.
/// @param step  called after each cycle with what is compared with the tolerance
/// @param surface where the error counts; null for the residual alone
SolverReport conjugate_gradients(const GridOperator& a, Multigrid& preconditioner, const RightHandSide& b,
                                 const SolverOptions& options, SolverWork& work, Buffer<float>& x,
                                 const std::function<void(double)>& step, SurfaceError* surface = nullptr);

/// Receives each search direction p [point] and its length alpha: x = sum of alpha p.
using TakeDirection = std::function<void(double alpha, const Buffer<float>& p)>;

/// Solves A x = b for linear functions of x: there is no array x. `take` adds up what is asked of it, so that it is
/// not rounded to single precision either. The residual is the recursion's, and no true one corrects it: so products
/// with A are exact, with which it stays within a few parts in ten million of the true one.
/// @param work  its r is b; used up
SolverReport conjugate_gradients(Multigrid& preconditioner, const SolverOptions& options, SolverWork& work,
                                 const TakeDirection& take, const std::function<void(double)>& step);

}  // namespace espdiff::ESPDIFF_BACKEND
