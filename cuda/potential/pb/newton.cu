// newton.cu: the nonlinear residual, the Jacobian's diagonal, and damped steps.
#include "cuda/potential/pb/newton.h"

#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Avoids overflow of sinh. Converged potentials in the solvent are far smaller.
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

/// x in two parts; see SolverWork.
struct TwoParts {
  const Buffer<float>& high;
  const Buffer<float>& low;
};

/// r = b - faces - k sinh(x). The operator has the diagonal of the Jacobian at `jacobian_at`. @returns |r|
double nonlinear_residual(const GridOperator& on_grid, const Buffer<float>& k, const Buffer<float>& jacobian_at,
                          const Buffer<float>& b, const TwoParts& x, Buffer<float>& r) {
  r = b;
  subtract_exactly(on_grid, x.high, x.low, r);
  const float* const ions = raw(k);
  const float* const at = raw(jacobian_at);
  const float* const value = raw(x.high);
  const float* const rest = raw(x.low);
  const GridSize size = on_grid.size;
  float* const residual = raw(r);
  for_each_index(r.size(), [=] ESPDIFF_HD(std::size_t p) {
    if (!(ions[p] > 0.0F)) return;
    const int i = static_cast<int>(p % size.row()),
              j = static_cast<int>(p / size.row() % static_cast<std::size_t>(size.ny)),
              plane = static_cast<int>(p / size.plane());
    const bool is_inner = i > 0 && j > 0 && plane > 0 && i < size.nx - 1 && j < size.ny - 1 && plane < size.nz - 1;
    // The operator used k cosh(at) x for the ions' term.
    const float cosine = coshf(cut(at[p]));
    const float excess = cosine * value[p] - sinhf(cut(value[p]));
    if (is_inner) residual[p] += ions[p] * (excess + (cosine - coshf(cut(value[p]))) * rest[p]);
  });
  return std::sqrt(dot_product(r, r));
}

/// to = x + part * way, in two parts.
void go(const TwoParts& x, float part, const Buffer<float>& way, Buffer<float>& to, Buffer<float>& to_low) {
  const float* const from = raw(x.high);
  const float* const from_low = raw(x.low);
  const float* const along = raw(way);
  float* const out = raw(to);
  float* const out_low = raw(to_low);
  for_each_index(to.size(), [=] ESPDIFF_HD(std::size_t p) {
    const double whole = static_cast<double>(from[p]) + static_cast<double>(from_low[p]) +
                         static_cast<double>(part) * static_cast<double>(along[p]);
    out[p] = static_cast<float>(whole);
    out_low[p] = static_cast<float>(whole - static_cast<double>(out[p]));
  });
}

}  // namespace

NewtonReport newton(GridOperator& on_grid, const Buffer<float>& k, const Buffer<float>& b, const SolverOptions& options,
                    int max_steps, SolverWork& work, Buffer<float>& x, const std::function<void(double)>& step) {
  NewtonReport report;
  Buffer<float> residual(x.size(), 0.0F), way(x.size(), 0.0F), low(x.size(), 0.0F);
  const RightHandSide copy_residual = [&](Buffer<float>& of_step) { of_step = residual; };
  set_jacobian(on_grid, k, x);
  double norm = nonlinear_residual(on_grid, k, x, b, {x, low}, residual);
  SolverReport& told = report.solver;
  told.start_residual = norm / options.norm;
  if (!(norm <= options.norm)) {
    // A start with a strong potential where ions are now: sinh makes it far worse than zero.
    clear_inner(on_grid.size, x);
    set_jacobian(on_grid, k, x);
    norm = nonlinear_residual(on_grid, k, x, b, {x, low}, residual);
  }
  for (;;) {
    told.relative_residual = told.surface_error = norm / options.norm;
    told.converged = told.relative_residual <= options.tolerance;
    if (told.converged || report.steps >= max_steps || !std::isfinite(norm)) return report;
    Multigrid multigrid(on_grid);
    way.assign(x.size(), 0.0F);
    SolverOptions inner = options;
    inner.norm = norm;
    inner.tolerance = kStepTolerance;
    told.cycles += conjugate_gradients(on_grid, multigrid, copy_residual, inner, work, way, [](double) {}).cycles;
    ++report.steps;
    double part = 1, next = 0;
    for (int halvings = 0;; part *= 0.5, ++halvings) {
      go({x, low}, static_cast<float>(part), way, work.z, work.p);
      next = nonlinear_residual(on_grid, k, x, b, {work.z, work.p}, work.r);
      if (next < norm * (1 - 1e-4 * part) || halvings == kMostHalvings) break;
    }
    if (!(next < norm)) return report;  // no step length reduces the residual
    x = work.z;
    low = work.p;
    // They have the borders of x now; conjugate gradients expect zero there.
    work.z.assign(x.size(), 0.0F);
    work.p.assign(x.size(), 0.0F);
    set_jacobian(on_grid, k, x);
    norm = nonlinear_residual(on_grid, k, x, b, {x, low}, residual);
    step(norm / options.norm);
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
