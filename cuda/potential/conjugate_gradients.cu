// conjugate_gradients.cu: the iteration, its updates, and restarts from the true residual.
#include "cuda/potential/conjugate_gradients.h"

#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// x += alpha p, r -= alpha q.
void advance(float alpha, const Buffer<float>& p, const Buffer<float>& q, Buffer<float>& x, Buffer<float>& r) {
  const float* const along = raw(p);
  const float* const image = raw(q);
  float* const position = raw(x);
  float* const residual = raw(r);
  for_each_index(x.size(), [=] ESPDIFF_HD(std::size_t i) {
    position[i] += alpha * along[i];
    residual[i] -= alpha * image[i];
  });
}

/// p = z + beta p.
void turn(float beta, const Buffer<float>& z, Buffer<float>& p) {
  const float* const from = raw(z);
  float* const to = raw(p);
  for_each_index(p.size(), [=] ESPDIFF_HD(std::size_t i) { to[i] = from[i] + beta * to[i]; });
}

/// Conjugate gradients from the residual in work.r until the recursion's residual is below the tolerance. @returns it
double iterate(const GridOperator& a, Multigrid& preconditioner, const SolverOptions& options, SolverReport& report,
               SolverWork& work, Buffer<float>& x, const std::function<void(double)>& step) {
  double rz_before = 0, residual = report.relative_residual;
  while (residual > options.tolerance && report.cycles < options.max_cycles) {
    preconditioner.precondition(work.r, work.z, work.scratch);
    const double rz = dot_product(work.r, work.z);
    if (rz_before == 0) {
      work.p = work.z;
    } else {
      turn(static_cast<float>(rz / rz_before), work.z, work.p);
    }
    rz_before = rz;
    apply_operator(a, work.p, work.scratch);
    const double curvature = dot_product(work.p, work.scratch);
    if (!(curvature > 0) || !(rz > 0)) break;  // the direction is rounding noise
    advance(static_cast<float>(rz / curvature), work.p, work.scratch, x, work.r);
    residual = std::sqrt(dot_product(work.r, work.r)) / options.norm;
    ++report.cycles;
    step(residual);
  }
  return residual;
}

}  // namespace

SolverReport conjugate_gradients(const GridOperator& a, Multigrid& preconditioner, const Buffer<float>& b,
                                 const SolverOptions& options, SolverWork& work, Buffer<float>& x,
                                 const std::function<void(double)>& step) {
  SolverReport report;
  work.low.assign(x.size(), 0.0F);
  constexpr int kMostRestarts = 6;
  for (int restart = 0;; ++restart) {
    exact_residual(a, x, work.low, b, work.r);
    report.relative_residual = std::sqrt(dot_product(work.r, work.r)) / options.norm;
    if (restart == 0) report.start_residual = report.relative_residual;
    if (restart == 0 && report.relative_residual > 1) {  // worse than zero
      clear_inner(a.size, x);
      exact_residual(a, x, work.low, b, work.r);
      report.relative_residual = std::sqrt(dot_product(work.r, work.r)) / options.norm;
    }
    report.converged = report.relative_residual <= options.tolerance;
    const bool is_over = report.cycles >= options.max_cycles || restart == kMostRestarts;
    if (report.converged || is_over || !std::isfinite(report.relative_residual)) break;
    // The first pass finds x itself, the others what rounding left of it.
    if (restart > 1) add_parts(x, work.low);
    iterate(a, preconditioner, options, report, work, restart == 0 ? x : work.low, step);
  }
  add_parts(x, work.low);
  return report;
}

}  // namespace espdiff::ESPDIFF_BACKEND
