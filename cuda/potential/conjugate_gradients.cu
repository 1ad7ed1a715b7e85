// conjugate_gradients.cu: the iteration and its updates.
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

/// Conjugate gradients from the residual in work.r, until the residual that they carry along is small enough, which is
/// returned.
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
    if (!(curvature > 0) || !(rz > 0)) break;  // rounding has eaten the direction
    advance(static_cast<float>(rz / curvature), work.p, work.scratch, x, work.r);
    residual = std::sqrt(dot_product(work.r, work.r)) / options.norm;
    ++report.cycles;
    step(residual);
  }
  return residual;
}

}  // namespace

double rounding_residual(const GridOperator& a, const Buffer<float>& x) {
  constexpr double kHalfUnit = 5.9604645e-8;  // 2^-24
  const float* const diagonal = raw(a.diagonal);
  const float* const value = raw(x);
  return kHalfUnit * std::sqrt(sum_over<double>(x.size(), [=] ESPDIFF_HD(std::size_t i) {
           const double term = static_cast<double>(diagonal[i]) * static_cast<double>(value[i]);
           return term * term;
         }));
}

SolverReport conjugate_gradients(const GridOperator& a, Multigrid& preconditioner, const Buffer<float>& b,
                                 const SolverOptions& options, SolverWork& work, Buffer<float>& x,
                                 const std::function<void(double)>& step) {
  SolverReport report;
  double carried = 1e300;
  constexpr int kMostStarts = 4;
  for (int start = 0; start < kMostStarts; ++start) {
    operator_residual(a, x, b, work.r);
    report.relative_residual = std::sqrt(dot_product(work.r, work.r)) / options.norm;
    report.converged = report.relative_residual <= options.tolerance;
    if (!report.converged && carried <= options.tolerance) {
      report.rounding = rounding_residual(a, x) / options.norm;
      report.converged = report.relative_residual <= options.tolerance + kRoundings * report.rounding;
    }
    if (report.converged || report.cycles >= options.max_cycles || !std::isfinite(report.relative_residual)) break;
    carried = iterate(a, preconditioner, options, report, work, x, step);
  }
  return report;
}

}  // namespace espdiff::ESPDIFF_BACKEND
