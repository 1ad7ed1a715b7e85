// conjugate_gradients.cu: the iteration, its updates, and restarts from the true residual.
#include "cuda/potential/pb/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// How a direction p becomes A p, in work.z, and what is done with it.
struct Advance {
  Products products;
  std::function<double(float alpha)> by;                      ///< x += alpha p, r -= alpha A p. @returns r . r
  std::function<double(float alpha, double residual)> error;  ///< afterwards: what the tolerance is for
};

/// Conjugate gradients from the residual in work.r until the recursion's error is below the tolerance. @returns the
/// recursion's residual
double iterate(Multigrid& preconditioner, const SolverOptions& options, SolverReport& report, SolverWork& work,
               const Advance& advance_x, const std::function<void(double)>& step) {
  double rz_before = 0, residual = report.relative_residual;
  while (report.surface_error > options.tolerance && report.cycles < options.max_cycles) {
    const double rz = preconditioner.precondition(work.r, work.z);
    const float beta = rz_before == 0 ? 0.0F : static_cast<float>(rz / rz_before);
    const double curvature = preconditioner.turn_and_apply(beta, work.z, work.p, advance_x.products);
    rz_before = rz;
    if (!(curvature > 0) || !(rz > 0)) break;  // the direction is rounding noise
    const auto alpha = static_cast<float>(rz / curvature);
    residual = std::sqrt(advance_x.by(alpha)) / options.norm;
    report.surface_error = advance_x.error(alpha, residual);
    ++report.cycles;
    step(report.surface_error);
  }
  return residual;
}

double of_residual(float, double residual) { return residual; }

}  // namespace

SolverReport conjugate_gradients(const GridOperator& a, Multigrid& preconditioner, const RightHandSide& b,
                                 const SolverOptions& options, SolverWork& work, Buffer<float>& x,
                                 const std::function<void(double)>& step, SurfaceError* surface) {
  SolverReport report;
  Buffer<float> low;  // none until it is needed
  const bool has_surface = surface != nullptr && surface->is_known();
  const auto true_residual = [&] {
    b(work.r);
    subtract_exactly(a, x, low, work.r);
    return std::sqrt(dot_product(work.r, work.r)) / options.norm;
  };
  const auto error = [&](float alpha, double residual) {
    return has_surface ? surface->after_cycle(alpha, work.p, x) : residual;
  };
  constexpr int kMostRestarts = 6;
  double most = options.tolerance;  // of the true residual
  for (int restart = 0;; ++restart) {
    report.relative_residual = true_residual();
    if (restart == 0) report.start_residual = report.relative_residual;
    if (restart == 0 && report.relative_residual > 1 && !options.keeps_start) {  // worse than zero
      clear_inner(a.size, x);
      report.relative_residual = true_residual();
    }
    report.converged = report.relative_residual <= most;
    const bool is_over = report.cycles >= options.max_cycles || restart == kMostRestarts;
    if (report.converged || is_over || !std::isfinite(report.relative_residual)) break;
    report.surface_error = report.relative_residual;
    // The first pass finds x itself, the others what rounding left of it.
    if (restart == 1) low.assign(x.size(), 0.0F);
    if (restart > 1) add_parts(x, low);
    Buffer<float>& part = restart == 0 ? x : low;
    const auto advance_part = [&](float alpha) { return advance(alpha, work.p, work.z, part, work.r); };
    const double residual =
        iterate(preconditioner, options, report, work, {Products::kRounded, advance_part, error}, step);
    if (has_surface && report.surface_error <= options.tolerance) most = std::max(most, 2 * residual);
  }
  if (!low.empty()) add_parts(x, low);
  return report;
}

SolverReport conjugate_gradients(Multigrid& preconditioner, const SolverOptions& options, SolverWork& work,
                                 const TakeDirection& take, const std::function<void(double)>& step) {
  SolverReport report;
  report.start_residual = report.relative_residual = std::sqrt(dot_product(work.r, work.r)) / options.norm;
  report.surface_error = report.relative_residual;
  const auto take_and_subtract = [&](float alpha) {
    take(static_cast<double>(alpha), work.p);
    return subtract_scaled(alpha, work.z, work.r);
  };
  report.relative_residual =
      iterate(preconditioner, options, report, work, {Products::kExact, take_and_subtract, of_residual}, step);
  report.converged = report.relative_residual <= options.tolerance;
  return report;
}

}  // namespace espdiff::ESPDIFF_BACKEND
