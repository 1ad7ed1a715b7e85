// newton.cu: the nonlinear residual, the Jacobian's diagonal, and damped steps.
#include "cuda/potential/newton.h"

#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Beyond this sinh would overflow; where ions may be, no potential of a converged solution comes near it.
constexpr float kMostArgument = 50;
constexpr int kMostHalvings = 12;
constexpr double kStepTolerance = 0.1;

ESPDIFF_INLINE float cut(float x) { return smaller(larger(x, -kMostArgument), kMostArgument); }

/// operator's diagonal = faces + k cosh(x): the Jacobian at x.
void set_jacobian(GridOperator& on_grid, const Buffer<float>& k, const Buffer<float>& x) {
  const float* const ions = raw(k);
  const float* const value = raw(x);
  float* const diagonal = raw(on_grid.diagonal);
  for_each_index(k.size(), [=] ESPDIFF_HD(std::size_t p) {
    diagonal[p] = ions[p] > 0.0F ? ions[p] * coshf(cut(value[p])) : 0.0F;
  });
  add_faces_to_diagonal(on_grid);
}

/// r = b - faces - k sinh(x), from r as the linear operator with the Jacobian's diagonal left it.
double nonlinear_residual(const GridOperator& on_grid, const Buffer<float>& k, const Buffer<float>& jacobian_at,
                          const Buffer<float>& b, const Buffer<float>& x, Buffer<float>& r) {
  operator_residual(on_grid, x, b, r);
  const float* const ions = raw(k);
  const float* const at = raw(jacobian_at);
  const float* const value = raw(x);
  const GridSize size = on_grid.size;
  float* const residual = raw(r);
  for_each_index(r.size(), [=] ESPDIFF_HD(std::size_t p) {
    if (!(ions[p] > 0.0F)) return;
    const int i = static_cast<int>(p % size.row()),
              j = static_cast<int>(p / size.row() % static_cast<std::size_t>(size.ny)),
              plane = static_cast<int>(p / size.plane());
    const bool is_inner = i > 0 && j > 0 && plane > 0 && i < size.nx - 1 && j < size.ny - 1 && plane < size.nz - 1;
    // The operator took k cosh(at) x for the ions' term.
    if (is_inner) residual[p] += ions[p] * (coshf(cut(at[p])) * value[p] - sinhf(cut(value[p])));
  });
  return std::sqrt(dot_product(r, r));
}

/// to = x + part * way.
void go(const Buffer<float>& x, float part, const Buffer<float>& way, Buffer<float>& to) {
  const float* const from = raw(x);
  const float* const along = raw(way);
  float* const out = raw(to);
  for_each_index(x.size(), [=] ESPDIFF_HD(std::size_t p) { out[p] = from[p] + part * along[p]; });
}

}  // namespace

NewtonReport newton(GridOperator& on_grid, const Buffer<float>& k, const Buffer<float>& b, const SolverOptions& options,
                    int max_steps, SolverWork& work, Buffer<float>& x, const std::function<void(double)>& step) {
  NewtonReport report;
  Buffer<float> residual(x.size(), 0.0F), way(x.size(), 0.0F);
  set_jacobian(on_grid, k, x);
  double norm = nonlinear_residual(on_grid, k, x, b, x, residual);
  for (;;) {
    SolverReport& told = report.solver;
    told.relative_residual = norm / options.norm;
    told.converged = told.relative_residual <= options.tolerance;
    if (told.converged || report.steps >= max_steps || !std::isfinite(norm)) return report;
    Multigrid multigrid(on_grid);
    way.assign(x.size(), 0.0F);
    SolverOptions inner = options;
    inner.norm = norm;
    inner.tolerance = kStepTolerance;
    told.cycles += conjugate_gradients(on_grid, multigrid, residual, inner, work, way, [](double) {}).cycles;
    ++report.steps;
    double part = 1, next = 0;
    int halvings = 0;
    for (;; part *= 0.5, ++halvings) {
      go(x, static_cast<float>(part), way, work.z);
      next = nonlinear_residual(on_grid, k, x, b, work.z, work.scratch);
      if (next < norm * (1 - 1e-4 * part) || halvings == kMostHalvings) break;
    }
    if (!(next < norm)) {
      // No part of the way helps: what is left is rounding, or the end.
      told.rounding = rounding_residual(on_grid, x) / options.norm;
      told.converged = told.relative_residual <= options.tolerance + kRoundings * told.rounding;
      return report;
    }
    x = work.z;
    // The border of z is the one of x, which CG expects to be zero.
    work.z.assign(x.size(), 0.0F);
    work.scratch.assign(x.size(), 0.0F);
    set_jacobian(on_grid, k, x);
    norm = nonlinear_residual(on_grid, k, x, b, x, residual);
    step(norm / options.norm);
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
