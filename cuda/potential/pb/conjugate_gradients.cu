// conjugate_gradients.cu: the iteration, its updates, and restarts from the true residual.
#include "cuda/potential/pb/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Conjugate gradients from the residual in work.r until the recursion's residual is below the tolerance. @returns it
double iterate(Multigrid& preconditioner, const SolverOptions& options, SolverReport& report, SolverWork& work,
               Buffer<float>& x, const std::function<void(double)>& step) {
  double rz_before = 0, residual = report.relative_residual;
  while (residual > options.tolerance && report.cycles < options.max_cycles) {
    const double rz = preconditioner.precondition(work.r, work.z);
    const double curvature =
        preconditioner.turn_and_apply(rz_before == 0 ? 0.0F : static_cast<float>(rz / rz_before), work.z, work.p);
    rz_before = rz;
    if (!(curvature > 0) || !(rz > 0)) break;  // the direction is rounding noise
    residual = std::sqrt(advance(static_cast<float>(rz / curvature), work.p, work.z, x, work.r)) / options.norm;
    ++report.cycles;
    step(residual);
  }
  return residual;
}

}  // namespace

SolverReport conjugate_gradients(const GridOperator& a, Multigrid& preconditioner, const RightHandSide& b,
                                 const SolverOptions& options, SolverWork& work, Buffer<float>& x,
                                 const std::function<void(double)>& step) {
  SolverReport report;
  Buffer<float> low;  // none until it is needed
  const auto true_residual = [&] {
    b(work.r);
    subtract_exactly(a, x, low, work.r);
    return std::sqrt(dot_product(work.r, work.r)) / options.norm;
  };
  constexpr int kMostRestarts = 6;
  for (int restart = 0;; ++restart) {
    report.relative_residual = true_residual();
    if (restart == 0) report.start_residual = report.relative_residual;
    if (restart == 0 && report.relative_residual > 1) {  // worse than zero
      clear_inner(a.size, x);
      report.relative_residual = true_residual();
    }
    const bool has_iterated = report.cycles > 0;
    report.converged =
        report.relative_residual <= (has_iterated ? std::max(options.tolerance, options.rounding) : options.tolerance);
    const bool is_over = report.cycles >= options.max_cycles || restart == kMostRestarts;
    if (report.converged || is_over || !std::isfinite(report.relative_residual)) break;
    // The first pass finds x itself, the others what rounding left of it.
    if (restart == 1) low.assign(x.size(), 0.0F);
    if (restart > 1) add_parts(x, low);
    iterate(preconditioner, options, report, work, restart == 0 ? x : low, step);
  }
  if (!low.empty()) add_parts(x, low);
  return report;
}

}  // namespace espdiff::ESPDIFF_BACKEND
