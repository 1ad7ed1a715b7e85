// newton.h: the nonlinear Poisson-Boltzmann equation on a grid, by Newton's method around the linear solver.
#pragma once

#include <functional>

#include "cuda/potential/pb/conjugate_gradients.h"

namespace espdiff::ESPDIFF_BACKEND {

struct NewtonReport {
  SolverReport solver;  ///< cycles of all steps together; the nonlinear residual
  int steps = 0;
};

/// Solves sum_f eps_f (x_p - x_q) + k_p sinh(x_p) = b_p. Each step solves the linearized equation to a tenth of the
/// residual (inexact Newton). The step is halved until the residual's norm falls (Holst and Saied, J. Comput. Chem. 16,
/// 337 (1995)). The argument of sinh is limited to 50.
/// @param on_grid  its diagonal is overwritten in each step
/// @param k        [point] as GridOperator has it
/// @param options  max_cycles is the limit of each step
/// @param x        [point] start and result, with its border; a start worse than zero is replaced by zero
NewtonReport newton(GridOperator& on_grid, const Buffer<float>& k, const Buffer<float>& b, const SolverOptions& options,
                    int max_steps, SolverWork& work, Buffer<float>& x, const std::function<void(double)>& step);

}  // namespace espdiff::ESPDIFF_BACKEND
