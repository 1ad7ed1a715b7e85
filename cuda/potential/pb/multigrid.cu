// multigrid.cu: kernels of the operator, of Gauss-Seidel sweeps, and between grids; the V-cycle.
#include "cuda/potential/pb/multigrid.h"

#include <algorithm>

#include "cuda/potential/pb/plane_sweeps.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The operator's coefficients for kernels.
struct OperatorView {
  const float* ex;
  const float* ey;
  const float* ez;
  const float* diagonal;
  std::size_t row, plane;

  /// sum of eps_f x_q over the six neighbours.
  ESPDIFF_INLINE float neighbours(const float* x, std::size_t p) const {
    const float along_x = ex[p] * x[p + 1] + ex[p - 1] * x[p - 1];
    const float along_y = ey[p] * x[p + row] + ey[p - row] * x[p - row];
    const float along_z = ez[p] * x[p + plane] + ez[p - plane] * x[p - plane];
    return along_x + along_y + along_z;
  }
};

OperatorView view_of(const GridOperator& a) {
  return {raw(a.ex), raw(a.ey), raw(a.ez), raw(a.diagonal), a.size.row(), a.size.plane()};
}

struct AddFaces {
  static constexpr bool kColoured = false;
  int colour;
  OperatorView a;
  float* diagonal;

  ESPDIFF_INLINE void at(std::size_t p, int) const {
    const float faces = (a.ex[p] + a.ex[p - 1]) + (a.ey[p] + a.ey[p - a.row]) + (a.ez[p] + a.ez[p - a.plane]);
    diagonal[p] = diagonal[p] + faces;
  }
};
ESPDIFF_GRID_KERNEL(AddFaces)

struct Apply {
  static constexpr bool kColoured = false;
  int colour;
  OperatorView a;
  const float* x;
  float* y;

  ESPDIFF_INLINE void at(std::size_t p, int) const { y[p] = a.diagonal[p] * x[p] - a.neighbours(x, p); }
};
ESPDIFF_GRID_KERNEL(Apply)

/// The residual after a red and a black half sweep from zero: black points have none.
struct RedResidual {
  static constexpr bool kColoured = false;
  int colour;
  OperatorView a;
  const float* x;
  float* r;

  ESPDIFF_INLINE void at(std::size_t p, int of) const { r[p] = of == colour ? a.neighbours(x, p) : 0.0F; }
};
ESPDIFF_GRID_KERNEL(RedResidual)

/// r - A x for x in one or two parts, in double precision: float products are exact there.
template <bool TwoParts>
struct ExactResidual {
  static constexpr bool kColoured = false;
  int colour;
  OperatorView a;
  const float* x;
  const float* low;
  float* r;

  ESPDIFF_INLINE double whole(std::size_t p) const {
    if constexpr (TwoParts) return static_cast<double>(x[p]) + static_cast<double>(low[p]);
    return static_cast<double>(x[p]);
  }
  ESPDIFF_INLINE double term(const float* e, std::size_t face, std::size_t p) const {
    return static_cast<double>(e[face]) * whole(p);
  }
  ESPDIFF_INLINE void at(std::size_t p, int) const {
    const double along_x = term(a.ex, p, p + 1) + term(a.ex, p - 1, p - 1);
    const double along_y = term(a.ey, p, p + a.row) + term(a.ey, p - a.row, p - a.row);
    const double along_z = term(a.ez, p, p + a.plane) + term(a.ez, p - a.plane, p - a.plane);
    const double own = static_cast<double>(r[p]) - static_cast<double>(a.diagonal[p]) * whole(p);
    r[p] = static_cast<float>(own + (along_x + along_y + along_z));
  }
};
ESPDIFF_GRID_KERNEL(ExactResidual<false>)
ESPDIFF_GRID_KERNEL(ExactResidual<true>)

struct Clear {
  static constexpr bool kColoured = false;
  int colour;
  float* x;

  ESPDIFF_INLINE void at(std::size_t p, int) const { x[p] = 0.0F; }
};
ESPDIFF_GRID_KERNEL(Clear)

/// The first half of a sweep from zero: points of the colour by their own equation, the others zero.
struct StartSweep {
  static constexpr bool kColoured = false;
  int colour;
  OperatorView a;
  const float* b;
  float* x;

  ESPDIFF_INLINE void at(std::size_t p, int of) const { x[p] = of == colour ? b[p] / a.diagonal[p] : 0.0F; }
};
ESPDIFF_GRID_KERNEL(StartSweep)

/// Half a Gauss-Seidel sweep.
struct HalfSweep {
  static constexpr bool kColoured = true;
  int colour;
  OperatorView a;
  const float* b;
  float* x;

  ESPDIFF_INLINE void at(std::size_t p, int) const { x[p] = (b[p] + a.neighbours(x, p)) / a.diagonal[p]; }
};
ESPDIFF_GRID_KERNEL(HalfSweep)

constexpr int kRed = 0, kBlack = 1;

void half_sweep(const GridOperator& a, int colour, const Buffer<float>& b, Buffer<float>& x) {
  run_on_grid(a.size, HalfSweep{colour, view_of(a), raw(b), raw(x)});
}

/// Points of the next coarser grid along an axis. Its last point may lie one step beyond the finer grid.
int coarser(int n) { return n / 2 + 1; }

/// b of the coarse grid. No coarse point's neighbours lie beyond the fine grid.
void restrict_to(const GridSize& fine, const Buffer<float>& r, const GridSize& coarse, Buffer<float>& b) {
  const float* const from = raw(r);
  float* const to = raw(b);
  const auto row_of = [=] ESPDIFF_HD(std::size_t index) {
    const int j = static_cast<int>(index % static_cast<std::size_t>(coarse.ny - 2)) + 1,
              k = static_cast<int>(index / static_cast<std::size_t>(coarse.ny - 2)) + 1;
    const float* const low = from + fine.index(0, 2 * j, 2 * k - 1);
    const float* const mid = from + fine.index(0, 2 * j, 2 * k);
    const float* const high = from + fine.index(0, 2 * j, 2 * k + 1);
    const std::size_t row = fine.row();
    float before = across_weighted(low + 1, mid + 1, high + 1, row);
    for (int i = 1; i < coarse.nx - 1; ++i) {
      const int x = 2 * i;
      const float after = across_weighted(low + x + 1, mid + x + 1, high + x + 1, row);
      to[coarse.index(i, j, k)] = along_weighted(before, across_weighted(low + x, mid + x, high + x, row), after);
      before = after;
    }
  };
  for_each_index(static_cast<std::size_t>(coarse.ny - 2) * static_cast<std::size_t>(coarse.nz - 2), row_of);
}

/// x += trilinear interpolation of the coarse grid's.
void add_interpolated(const GridSize& coarse, const Buffer<float>& correction, const GridSize& fine, Buffer<float>& x) {
  const float* const from = raw(correction);
  float* const to = raw(x);
  for_each_index(static_cast<std::size_t>(fine.ny - 2) * static_cast<std::size_t>(fine.nz - 2),
                 [=] ESPDIFF_HD(std::size_t index) {
                   const int j = static_cast<int>(index % static_cast<std::size_t>(fine.ny - 2)) + 1,
                             k = static_cast<int>(index / static_cast<std::size_t>(fine.ny - 2)) + 1;
                   const int j0 = j / 2, j1 = (j + 1) / 2, k0 = k / 2, k1 = (k + 1) / 2;
                   const float* const a = from + coarse.index(0, j0, k0);
                   const float* const b = from + coarse.index(0, j1, k0);
                   const float* const c = from + coarse.index(0, j0, k1);
                   const float* const d = from + coarse.index(0, j1, k1);
                   float* const row = to + fine.index(0, j, k);
                   for (int i = 1; i < fine.nx - 1; ++i) {
                     const int i0 = i / 2, i1 = (i + 1) / 2;
                     row[i] += 0.125F * (((a[i0] + b[i0]) + (c[i0] + d[i0])) + ((a[i1] + b[i1]) + (c[i1] + d[i1])));
                   }
                 });
}

/// Two faces in series.
ESPDIFF_INLINE float in_series(float a, float b) { return 2.0F * a * b / (a + b); }

struct Step {
  std::size_t along, side, up;  ///< to the next point along the face's normal, and across it
};

/// A coarse face: two fine ones in series, averaged over the lines beside by 1/4, 1/8, 1/16.
ESPDIFF_INLINE float coarse_face(const float* e, const GridSize& fine, int axis, int i, int j, int k) {
  const int n[3] = {fine.nx, fine.ny, fine.nz};
  float sum = 0, weights = 0;
  for (int u = -1; u <= 1; ++u) {
    for (int v = -1; v <= 1; ++v) {
      int at[3] = {2 * i, 2 * j, 2 * k};
      at[(axis + 1) % 3] += u;
      at[(axis + 2) % 3] += v;
      bool inside = true;
      for (int a = 0; a < 3; ++a) inside = inside && at[a] >= 0 && at[a] < n[a];
      if (!inside || at[axis] > n[axis] - 2) continue;
      int next[3] = {at[0], at[1], at[2]};
      if (at[axis] + 1 < n[axis] - 1) ++next[axis];
      const float weight = (u == 0 ? 2.0F : 1.0F) * (v == 0 ? 2.0F : 1.0F);
      sum += weight * in_series(e[fine.index(at[0], at[1], at[2])], e[fine.index(next[0], next[1], next[2])]);
      weights += weight;
    }
  }
  return weights > 0 ? sum / weights : 1.0F;
}

void coarsen(const GridOperator& fine, GridOperator& coarse) {
  const GridSize f = fine.size;
  const GridSize c{coarser(f.nx), coarser(f.ny), coarser(f.nz)};
  coarse.size = c;
  for (Buffer<float>* buffer : {&coarse.ex, &coarse.ey, &coarse.ez, &coarse.diagonal}) buffer->resize(c.points());
  const OperatorView from = view_of(fine);
  float* const ex = raw(coarse.ex);
  float* const ey = raw(coarse.ey);
  float* const ez = raw(coarse.ez);
  float* const diagonal = raw(coarse.diagonal);
  for_each_index(c.points(), [=] ESPDIFF_HD(std::size_t p) {
    const int i = static_cast<int>(p % c.row()), j = static_cast<int>(p / c.row() % static_cast<std::size_t>(c.ny)),
              k = static_cast<int>(p / c.plane());
    ex[p] = coarse_face(from.ex, f, 0, i, j, k);
    ey[p] = coarse_face(from.ey, f, 1, i, j, k);
    ez[p] = coarse_face(from.ez, f, 2, i, j, k);
    // k is the diagonal minus the faces; it quadruples with the doubled spacing.
    float ions = 0;
    const bool is_inner = i > 0 && j > 0 && k > 0 && 2 * i < f.nx - 1 && 2 * j < f.ny - 1 && 2 * k < f.nz - 1;
    if (is_inner) {
      const std::size_t q = f.index(2 * i, 2 * j, 2 * k);
      const float faces =
          (from.ex[q] + from.ex[q - 1]) + (from.ey[q] + from.ey[q - from.row]) + (from.ez[q] + from.ez[q - from.plane]);
      ions = 4.0F * larger(from.diagonal[q] - faces, 0.0F);
    }
    diagonal[p] = ions;
  });
  add_faces_to_diagonal(coarse);
}

}  // namespace

double dot_product(const Buffer<float>& a, const Buffer<float>& b) {
  const float* const x = raw(a);
  const float* const y = raw(b);
  const std::size_t n = a.size(), lanes = LaneSums::kLanes;
  return sum_over<LaneSums>(
             (n + lanes - 1) / lanes,
             [=] ESPDIFF_HD(std::size_t block) {
               LaneSums term;
               const std::size_t first = block * lanes;
               if (first + lanes <= n) {
                 for (std::size_t lane = 0; lane < lanes; ++lane)
                   term.sum[lane] = static_cast<double>(x[first + lane]) * static_cast<double>(y[first + lane]);
               } else {
                 for (std::size_t lane = 0; first + lane < n; ++lane)
                   term.sum[lane] = static_cast<double>(x[first + lane]) * static_cast<double>(y[first + lane]);
               }
               return term;
             })
      .total();
}

void add_faces_to_diagonal(GridOperator& a) { run_on_grid(a.size, AddFaces{0, view_of(a), raw(a.diagonal)}); }
void apply_operator(const GridOperator& a, const Buffer<float>& x, Buffer<float>& y) {
  run_on_grid(a.size, Apply{0, view_of(a), raw(x), raw(y)});
}
void subtract_exactly(const GridOperator& a, const Buffer<float>& x, const Buffer<float>& low, Buffer<float>& r) {
  if (low.empty()) {
    run_on_grid(a.size, ExactResidual<false>{0, view_of(a), raw(x), nullptr, raw(r)});
  } else {
    run_on_grid(a.size, ExactResidual<true>{0, view_of(a), raw(x), raw(low), raw(r)});
  }
}

void clear_inner(const GridSize& size, Buffer<float>& x) { run_on_grid(size, Clear{0, raw(x)}); }

void add_parts(Buffer<float>& x, Buffer<float>& low) {
  float* const high = raw(x);
  float* const rest = raw(low);
  for_each_index(x.size(), [=] ESPDIFF_HD(std::size_t p) {
    const double whole = static_cast<double>(high[p]) + static_cast<double>(rest[p]);
    high[p] = static_cast<float>(whole);
    rest[p] = static_cast<float>(whole - static_cast<double>(high[p]));
  });
}

Multigrid::Multigrid(const GridOperator& finest) : finest_(finest) {
  constexpr int kFewest = 7;
  const GridOperator* last = &finest;
  levels_.reserve(16);
  while (std::min({last->size.nx, last->size.ny, last->size.nz}) >= kFewest) {
    levels_.emplace_back();
    Level& level = levels_.back();
    coarsen(*last, level.on_grid);
    for (Buffer<float>* buffer : {&level.x, &level.b}) buffer->assign(level.on_grid.size.points(), 0.0F);
    last = &level.on_grid;
  }
#if !defined(ESPDIFF_BACKEND_CUDA)
  sweeps_ = std::make_unique<PlaneSweeps>(finest.size);
#endif
}

Multigrid::~Multigrid() = default;

void Multigrid::precondition_by_points(const Buffer<float>& r, Buffer<float>& z) {
  if (residual_.empty()) {
    residual_.assign(r.size(), 0.0F);
    for (Level& level : levels_) level.r.assign(level.x.size(), 0.0F);
  }
  cycle_by_points(0, finest_, r, z, residual_);
}

namespace {

/// Without a coarser grid: sweeps, symmetric.
void sweep_coarsest(const GridOperator& a, const Buffer<float>& b, Buffer<float>& x) {
  run_on_grid(a.size, StartSweep{kRed, view_of(a), raw(b), raw(x)});
  half_sweep(a, kBlack, b, x);
  constexpr int kSweeps = 8;
  for (int i = 1; i < kSweeps; ++i) {
    half_sweep(a, kRed, b, x);
    half_sweep(a, kBlack, b, x);
  }
  for (int i = 0; i < kSweeps; ++i) {
    half_sweep(a, kBlack, b, x);
    half_sweep(a, kRed, b, x);
  }
}

}  // namespace

void Multigrid::cycle_by_points(std::size_t depth, const GridOperator& a, const Buffer<float>& b, Buffer<float>& x,
                                Buffer<float>& r) {
  if (depth == levels_.size()) {
    sweep_coarsest(a, b, x);
    return;
  }
  run_on_grid(a.size, StartSweep{kRed, view_of(a), raw(b), raw(x)});
  half_sweep(a, kBlack, b, x);
  Level& next = levels_[depth];
  run_on_grid(a.size, RedResidual{kRed, view_of(a), raw(x), raw(r)});
  restrict_to(a.size, r, next.on_grid.size, next.b);
  cycle_by_points(depth + 1, next.on_grid, next.b, next.x, next.r);
  add_interpolated(next.on_grid.size, next.x, a.size, x);
  half_sweep(a, kBlack, b, x);
  half_sweep(a, kRed, b, x);
}

#if defined(ESPDIFF_BACKEND_CUDA)

double Multigrid::precondition(const Buffer<float>& r, Buffer<float>& z) {
  precondition_by_points(r, z);
  return dot_product(r, z);
}

double Multigrid::turn_and_apply(float beta, Buffer<float>& z, Buffer<float>& p) {
  const float* const from = raw(z);
  float* const to = raw(p);
  for_each_index(p.size(), [=] ESPDIFF_HD(std::size_t i) { to[i] = from[i] + beta * to[i]; });
  apply_operator(finest_, p, z);
  return dot_product(p, z);
}

double advance(float alpha, const Buffer<float>& p, const Buffer<float>& q, Buffer<float>& x, Buffer<float>& r) {
  const float* const along = raw(p);
  const float* const image = raw(q);
  float* const position = raw(x);
  float* const residual = raw(r);
  for_each_index(x.size(), [=] ESPDIFF_HD(std::size_t i) {
    position[i] += alpha * along[i];
    residual[i] -= alpha * image[i];
  });
  return dot_product(r, r);
}

#else

double Multigrid::precondition(const Buffer<float>& r, Buffer<float>& z) { return cycle_by_planes(0, finest_, r, z); }

double Multigrid::cycle_by_planes(std::size_t depth, const GridOperator& a, const Buffer<float>& b, Buffer<float>& x) {
  if (depth == levels_.size()) {
    sweep_coarsest(a, b, x);
    return depth == 0 ? dot_product(b, x) : 0;
  }
  Level& next = levels_[depth];
  sweeps_->smooth_and_restrict(a, b, x, next.on_grid.size, next.b);
  cycle_by_planes(depth + 1, next.on_grid, next.b, next.x);
  return sweeps_->correct_and_smooth(a, b, next.on_grid.size, next.x, x);
}

double Multigrid::turn_and_apply(float beta, Buffer<float>& z, Buffer<float>& p) {
  return sweeps_->turn_and_apply(finest_, beta, z, p);
}

double advance(float alpha, const Buffer<float>& p, const Buffer<float>& q, Buffer<float>& x, Buffer<float>& r) {
  return advance_by_runs(alpha, p, q, x, r);
}

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
