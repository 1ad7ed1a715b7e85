// conjugate_gradients.h: A x = b on a grid by conjugate gradients with a multigrid cycle as preconditioner.
#pragma once

#include <functional>

#include "cuda/potential/multigrid.h"

namespace espdiff::ESPDIFF_BACKEND {

struct SolverOptions {
  double tolerance = 1e-6;  ///< of |b - A x| / norm
  double norm = 1;          ///< what residuals are relative to
  int max_cycles = 100;
};

struct SolverReport {
  double relative_residual = 0;  ///< computed anew from b - A x
  double rounding = 0;           ///< part of it that single precision leaves; 0 where that did not matter
  int cycles = 0;
  bool converged = false;
};

/// The arrays that the iteration needs beside x and b; [point] each.
struct SolverWork {
  explicit SolverWork(std::size_t n_points) : r(n_points, 0), p(n_points, 0), z(n_points, 0), scratch(n_points, 0) {}
  Buffer<float> r, p, z, scratch;
};

/// |A| |x| in units of single precision's rounding: what storing x alone makes of |b - A x|.
double rounding_residual(const GridOperator& a, const Buffer<float>& x);
/// How many of them a residual may have: rounding of the sum over the neighbours comes on top.
constexpr double kRoundings = 3;

/// Single precision arrays, sums in double. The residual that the recursion carries drifts from the true one, which is
/// computed when the former says that it is done; where it is not small enough, the iteration starts again from there
/// (Qi and Luo, J. Chem. Inf. Model. 59, 409 (2019), found that hybrid robust in single precision where multigrid alone
/// was not). It is done, too, where rounding of x to single precision leaves a larger residual than was asked for.
/// @param x     [point] the start and the result; its border holds the Dirichlet values
/// @param step  called after each cycle with the relative residual
SolverReport conjugate_gradients(const GridOperator& a, Multigrid& preconditioner, const Buffer<float>& b,
                                 const SolverOptions& options, SolverWork& work, Buffer<float>& x,
                                 const std::function<void(double)>& step);

}  // namespace espdiff::ESPDIFF_BACKEND
