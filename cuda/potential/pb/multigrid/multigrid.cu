// multigrid.cu: kernels of the operator and of Gauss-Seidel sweeps; the V-cycle.
#include "cuda/potential/pb/multigrid/multigrid.h"

#include <algorithm>
#include <utility>

#include "cuda/potential/pb/multigrid/grid_transfer.h"
#include "cuda/potential/pb/multigrid/packed_operator.h"
#include "cuda/potential/pb/multigrid/plane_loops.h"
#include "cuda/potential/pb/multigrid/plane_sweeps.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The operator's coefficients for kernels.
struct OperatorView {
  const float* ex;
  const float* ey;
  const float* ez;
  const float* diagonal;
  std::size_t row, plane;

  template <typename Sum>
  static ESPDIFF_INLINE Sum product(float a, float b) {
    return static_cast<Sum>(a) * static_cast<Sum>(b);
  }
  /// sum of eps_f x_q over the six neighbours.
  template <typename Sum = float>
  ESPDIFF_INLINE Sum neighbours(const float* x, std::size_t p) const {
    const Sum along_x = product<Sum>(ex[p], x[p + 1]) + product<Sum>(ex[p - 1], x[p - 1]);
    const Sum along_y = product<Sum>(ey[p], x[p + row]) + product<Sum>(ey[p - row], x[p - row]);
    const Sum along_z = product<Sum>(ez[p], x[p + plane]) + product<Sum>(ez[p - plane], x[p - plane]);
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

template <typename Sum>
struct Apply {
  static constexpr bool kColoured = false;
  int colour;
  OperatorView a;
  const float* x;
  float* y;

  ESPDIFF_INLINE void at(std::size_t p, int) const {
    y[p] = static_cast<float>(a.product<Sum>(a.diagonal[p], x[p]) - a.neighbours<Sum>(x, p));
  }
};
ESPDIFF_GRID_KERNEL(Apply<float>)
ESPDIFF_GRID_KERNEL(Apply<double>)

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

}  // namespace

double dot_product(const Buffer<float>& a, const Buffer<float>& b) {
  const float* const x = raw(a);
  const float* const y = raw(b);
  const std::size_t n = a.size(), lanes = LaneSums::kLanes;
#if !defined(ESPDIFF_BACKEND_CUDA)
  // The chunks of sum_over(), each by a loop that the processor's widest vectors run.
  const std::size_t in_chunk = kReductionChunk * lanes, n_chunks = (n + in_chunk - 1) / in_chunk;
  Buffer<LaneSums> of_chunk(n_chunks);
  LaneSums* const sums = raw(of_chunk);
  for_each_index(n_chunks, [=](std::size_t chunk) {
    LaneSums sum;
    add_products(x, y, chunk * in_chunk, std::min((chunk + 1) * in_chunk, n), sum);
    sums[chunk] = sum;
  });
  LaneSums total;
  for (const LaneSums& sum : of_chunk) total += sum;
  return total.total();
#else
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
#endif
}

void add_faces_to_diagonal(GridOperator& a, std::shared_ptr<const PackedOperator> packed) {
#if !defined(ESPDIFF_BACKEND_CUDA)
  if (packed != nullptr) {
    a.packed = std::move(packed);
    a.diagonal = Buffer<float>();
    return;
  }
#else
  (void)packed;
#endif
  run_on_grid(a.size, AddFaces{0, view_of(a), raw(a.diagonal)});
}
void apply_operator(const GridOperator& a, const Buffer<float>& x, Buffer<float>& y, Products products) {
  if (products == Products::kExact)
    run_on_grid(a.size, Apply<double>{0, view_of(a), raw(x), raw(y)});
  else
    run_on_grid(a.size, Apply<float>{0, view_of(a), raw(x), raw(y)});
}
void subtract_exactly(const GridOperator& a, const Buffer<float>& x, const Buffer<float>& low, Buffer<float>& r) {
#if !defined(ESPDIFF_BACKEND_CUDA)
  if (a.packed != nullptr) return subtract_exactly_by_rows(a, x, low, r);
#endif
  if (low.empty()) {
    run_on_grid(a.size, ExactResidual<false>{0, view_of(a), raw(x), nullptr, raw(r)});
  } else {
    run_on_grid(a.size, ExactResidual<true>{0, view_of(a), raw(x), raw(low), raw(r)});
  }
}

CoefficientBuffers spare_arrays(GridOperator& a) {
  CoefficientBuffers given;
  if (a.packed != nullptr) std::swap(given, static_cast<CoefficientBuffers&>(a));
  return given;
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

Multigrid::Multigrid(const GridOperator& finest, std::size_t fewest_packed) : finest_(finest) {
  constexpr int kFewest = 7;
  const GridOperator* last = &finest;
  levels_.reserve(16);
  while (std::min({last->size.nx, last->size.ny, last->size.nz}) >= kFewest) {
    levels_.emplace_back();
    Level& level = levels_.back();
    coarsen(*last, level.on_grid);
    last = &level.on_grid;
  }
#if !defined(ESPDIFF_BACKEND_CUDA)
  pack_coarse_faces(fewest_packed);
#else
  (void)fewest_packed;
#endif
  for (Level& level : levels_) {
    for (Buffer<float>* buffer : {&level.x, &level.b}) buffer->assign(level.on_grid.size.points(), 0.0F);
  }
#if !defined(ESPDIFF_BACKEND_CUDA)
  sweeps_ = std::make_unique<PlaneSweeps>(finest.size);
#endif
}

#if !defined(ESPDIFF_BACKEND_CUDA)
void Multigrid::pack_coarse_faces(std::size_t fewest_points) {
  if (finest_.packed == nullptr) return;
  UsualCoefficients usual = finest_.packed->view().usual;
  for (Level& level : levels_) {
    GridOperator& a = level.on_grid;
    // The coarsest grid is swept from its arrays.
    if (a.size.points() < fewest_points || &level == &levels_.back()) return;
    usual.solute = coarse_face_of_equal(usual.solute);
    usual.solvent = coarse_face_of_equal(usual.solvent);
    constexpr std::size_t kPointsPerListed = 2;  // four bytes a point, where arrays take twelve
    a.packed = PackedOperator::pack(a, usual, kPointsPerListed);
    if (a.packed == nullptr) return;
    for (Buffer<float>* faces : {&a.ex, &a.ey, &a.ez}) *faces = Buffer<float>();
  }
}
#endif

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

double Multigrid::turn_and_apply(float beta, Buffer<float>& z, Buffer<float>& p, Products products) {
  const float* const from = raw(z);
  float* const to = raw(p);
  for_each_index(p.size(), [=] ESPDIFF_HD(std::size_t i) { to[i] = from[i] + beta * to[i]; });
  apply_operator(finest_, p, z, products);
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

double subtract_scaled(float alpha, const Buffer<float>& q, Buffer<float>& r) {
  const float* const image = raw(q);
  float* const residual = raw(r);
  for_each_index(r.size(), [=] ESPDIFF_HD(std::size_t i) { residual[i] -= alpha * image[i]; });
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

double Multigrid::turn_and_apply(float beta, Buffer<float>& z, Buffer<float>& p, Products products) {
  return sweeps_->turn_and_apply(finest_, beta, products, z, p);
}

double advance(float alpha, const Buffer<float>& p, const Buffer<float>& q, Buffer<float>& x, Buffer<float>& r) {
  return advance_by_runs(alpha, raw(p), raw(q), raw(x), r);
}

double subtract_scaled(float alpha, const Buffer<float>& q, Buffer<float>& r) {
  return advance_by_runs(alpha, nullptr, raw(q), nullptr, r);
}

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
