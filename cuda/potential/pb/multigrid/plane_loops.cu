// plane_loops.cu: the loops over the rows of a plane.
#include "cuda/potential/pb/multigrid/plane_loops.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// sum of eps_f x_q over the six neighbours of a row's points, for loops that the compiler vectorizes.
template <typename Sum>
struct RowNeighbours {
  const float *ex, *ey, *ey_before, *ez, *ez_below, *below, *here, *above;
  std::ptrdiff_t row;

  ESPDIFF_INLINE RowNeighbours(const OperatorRow& a, const Planes& x, std::size_t of_row)
      : ex(a.ex),
        ey(a.ey),
        ey_before(a.ey_before),
        ez(a.ez),
        ez_below(a.ez_below),
        below(x.below),
        here(x.here),
        above(x.above),
        row(static_cast<std::ptrdiff_t>(of_row)) {}
  static ESPDIFF_INLINE Sum product(float a, float b) { return static_cast<Sum>(a) * static_cast<Sum>(b); }
  ESPDIFF_INLINE Sum operator()(std::ptrdiff_t i) const {
    const Sum along_x = product(ex[i], here[i + 1]) + product(ex[i - 1], here[i - 1]);
    const Sum along_y = product(ey[i], here[i + row]) + product(ey_before[i], here[i - row]);
    const Sum along_z = product(ez[i], above[i]) + product(ez_below[i], below[i]);
    return along_x + along_y + along_z;
  }
};

/// The same for the plain ends of a row, whose faces all have one dielectric: the same products, without reading it for
/// each.
struct PlainNeighbours {
  float e;
  const float *below, *here, *above;
  std::ptrdiff_t row;

  ESPDIFF_INLINE PlainNeighbours(const OperatorRow& a, const Planes& x, std::size_t of_row)
      : e(a.plain), below(x.below), here(x.here), above(x.above), row(static_cast<std::ptrdiff_t>(of_row)) {}
  static ESPDIFF_INLINE float product(float a, float b) { return a * b; }
  ESPDIFF_INLINE float operator()(std::ptrdiff_t i) const {
    const float along_x = e * here[i + 1] + e * here[i - 1];
    const float along_y = e * here[i + row] + e * here[i - row];
    const float along_z = e * above[i] + e * below[i];
    return along_x + along_y + along_z;
  }
};

ESPDIFF_INLINE void start(const float* diagonal, int first, int last, int parity, const float* b, float* x) {
#pragma GCC ivdep
  for (int i = first; i < last; ++i) {
    const float all = b[i] / diagonal[i];
    x[i] = ((i + parity) & 1) == 0 ? all : 0.0F;
  }
}
ESPDIFF_MULTIVERSION void start_row(const OperatorRow& a, int parity, const float* b, float* x) {
  const OperatorRow of = a;
  start(of.plain_diagonal, 1, of.first, parity, b, x);
  start(of.diagonal, of.first, of.last, parity, b, x);
  start(of.plain_diagonal, of.last, of.end, parity, b, x);
}

template <typename Neighbours>
ESPDIFF_INLINE void sweep(const Neighbours& of, const float* diagonal, int first, int last, int parity, int colour,
                          const float* b, const float* here, float* out) {
  const Neighbours neighbours = of;
#pragma GCC ivdep
  for (int i = first; i < last; ++i) {
    const float renewed = (b[i] + neighbours(i)) / diagonal[i];
    out[i] = ((i + parity) & 1) == colour ? renewed : here[i];
  }
}
ESPDIFF_MULTIVERSION void sweep_row(const OperatorRow& a, std::size_t nx, int parity, int colour, const float* b,
                                    const Planes& x, float* out) {
  const OperatorRow of = a;
  const PlainNeighbours plain(of, x, nx);
  const float* const here = x.here;
  sweep(plain, of.plain_diagonal, 1, of.first, parity, colour, b, here, out);
  sweep(RowNeighbours<float>(of, x, nx), of.diagonal, of.first, of.last, parity, colour, b, here, out);
  sweep(plain, of.plain_diagonal, of.last, of.end, parity, colour, b, here, out);
}

template <typename Neighbours>
ESPDIFF_INLINE void red_residual(const Neighbours& of, int first, int last, int parity, float* r) {
  const Neighbours neighbours = of;
#pragma GCC ivdep
  for (int i = first; i < last; ++i) {
    const float all = neighbours(i);  // of black points too: loads under a mask are slower
    r[i] = ((i + parity) & 1) == 0 ? all : 0.0F;
  }
}
ESPDIFF_MULTIVERSION void residual_row(const OperatorRow& a, std::size_t nx, int parity, const Planes& x, float* r) {
  const OperatorRow of = a;
  const PlainNeighbours plain(of, x, nx);
  red_residual(plain, 1, of.first, parity, r);
  red_residual(RowNeighbours<float>(of, x, nx), of.first, of.last, parity, r);
  red_residual(plain, of.last, of.end, parity, r);
}

template <typename Neighbours>
ESPDIFF_INLINE void multiply(const Neighbours& of, const float* diagonal, int first, int last, const float* here,
                             float* y) {
  const Neighbours neighbours = of;
#pragma GCC ivdep
  for (int i = first; i < last; ++i)
    y[i] = static_cast<float>(neighbours.product(diagonal[i], here[i]) - neighbours(i));
}
ESPDIFF_MULTIVERSION void apply_row(const OperatorRow& a, std::size_t nx, const Planes& x, float* y) {
  const OperatorRow of = a;
  const PlainNeighbours plain(of, x, nx);
  multiply(plain, of.plain_diagonal, 1, of.first, x.here, y);
  multiply(RowNeighbours<float>(of, x, nx), of.diagonal, of.first, of.last, x.here, y);
  multiply(plain, of.plain_diagonal, of.last, of.end, x.here, y);
}
ESPDIFF_MULTIVERSION void apply_row_exactly(const OperatorRow& a, std::size_t nx, const Planes& x, float* y) {
  multiply(RowNeighbours<double>(a, x, nx), a.diagonal, a.first, a.last, x.here, y);
}

/// The terms of A x in double precision, for x in one or two parts.
template <bool TwoParts>
ESPDIFF_INLINE void subtract_row(const OperatorRow& a, std::size_t nx, std::size_t plane, const float* x,
                                 const float* low, float* r) {
  const OperatorRow of = a;
  const auto whole = [=](std::size_t p) ESPDIFF_INLINE_LAMBDA {
    if constexpr (TwoParts) return static_cast<double>(x[p]) + static_cast<double>(low[p]);
    return static_cast<double>(x[p]);
  };
#pragma GCC ivdep
  for (std::size_t i = 1; i < nx - 1; ++i) {
    const auto term = [&](const float* faces, std::size_t face, double value)
                          ESPDIFF_INLINE_LAMBDA { return static_cast<double>(faces[face]) * value; };
    const double along_x = term(of.ex, i, whole(i + 1)) + term(of.ex, i - 1, whole(i - 1));
    const double along_y = term(of.ey, i, whole(i + nx)) + term(of.ey_before, i, whole(i - nx));
    const double along_z = term(of.ez, i, whole(i + plane)) + term(of.ez_below, i, whole(i - plane));
    const double own = static_cast<double>(r[i]) - static_cast<double>(of.diagonal[i]) * whole(i);
    r[i] = static_cast<float>(own + (along_x + along_y + along_z));
  }
}
ESPDIFF_MULTIVERSION void subtract_row_of_one(const OperatorRow& a, std::size_t nx, std::size_t plane, const float* x,
                                              float* r) {
  subtract_row<false>(a, nx, plane, x, nullptr, r);
}
ESPDIFF_MULTIVERSION void subtract_row_of_two(const OperatorRow& a, std::size_t nx, std::size_t plane, const float* x,
                                              const float* low, float* r) {
  subtract_row<true>(a, nx, plane, x, low, r);
}

/// Calls of_row(coefficients, first point, parity of the first point) for rows of plane k.
template <typename OfRow>
void for_rows(OperatorRows& a, const GridSize& size, int k, RowRange rows, const OfRow& of_row) {
  a.hold(k);
  for (int j = rows.first; j < rows.last; ++j) of_row(a.at(j, k), size.row() * static_cast<std::size_t>(j), j + k);
}

}  // namespace

void start_plane(OperatorRows& a, const GridSize& size, int k, RowRange rows, const float* b, float* x) {
  for_rows(a, size, k, rows, [&](const OperatorRow& row, std::size_t first, int parity) {
    start_row(row, parity, b + first, x + first);
  });
}
void sweep_plane(OperatorRows& a, const GridSize& size, int k, RowRange rows, int colour, const float* b,
                 const Planes& x, float* out) {
  for_rows(a, size, k, rows, [&](const OperatorRow& row, std::size_t first, int parity) {
    sweep_row(row, size.row(), parity, colour, b + first, x.row(first), out + first);
  });
}
void residual_plane(OperatorRows& a, const GridSize& size, int k, RowRange rows, const Planes& x, float* r) {
  for_rows(a, size, k, rows, [&](const OperatorRow& row, std::size_t first, int parity) {
    residual_row(row, size.row(), parity, x.row(first), r + first);
  });
}
void apply_plane(OperatorRows& a, const GridSize& size, int k, RowRange rows, Products products, const Planes& x,
                 float* y) {
  for_rows(a, size, k, rows, [&](const OperatorRow& row, std::size_t first, int) {
    if (products == Products::kExact)
      apply_row_exactly(row, size.row(), x.row(first), y + first);
    else
      apply_row(row, size.row(), x.row(first), y + first);
  });
}

void subtract_exactly_plane(OperatorRows& a, const GridSize& size, int k, const float* x, const float* low, float* r) {
  for_rows(a, size, k, inner_rows(size), [&](const OperatorRow& row, std::size_t first, int) {
    if (low == nullptr)
      subtract_row_of_one(row, size.row(), size.plane(), x + first, r + first);
    else
      subtract_row_of_two(row, size.row(), size.plane(), x + first, low + first, r + first);
  });
}

ESPDIFF_MULTIVERSION void restrict_plane(const GridSize& fine, const Planes& r, const GridSize& coarse, RowRange rows,
                                         float* line, float* b) {
  const std::size_t row = fine.row();
  const int nx = fine.nx;
  for (int j = rows.first; j < rows.last; ++j) {
    const float* const low = r.below + row * static_cast<std::size_t>(2 * j);
    const float* const mid = r.here + row * static_cast<std::size_t>(2 * j);
    const float* const high = r.above + row * static_cast<std::size_t>(2 * j);
#pragma GCC ivdep
    for (int i = 0; i < nx; ++i) line[i] = across_weighted(low + i, mid + i, high + i, row);
    float* const out = b + coarse.row() * static_cast<std::size_t>(j);
#pragma GCC ivdep
    for (int i = 1; i < coarse.nx - 1; ++i) out[i] = along_weighted(line[2 * i - 1], line[2 * i], line[2 * i + 1]);
  }
}

ESPDIFF_MULTIVERSION void interpolate_plane(const GridSize& coarse, const float* below, const float* above,
                                            const GridSize& fine, RowRange rows, const float* x, float* line,
                                            float* out) {
  const std::size_t row = coarse.row();
  for (int j = rows.first; j < rows.last; ++j) {
    const float* const a = below + row * static_cast<std::size_t>(j / 2);
    const float* const b = below + row * static_cast<std::size_t>((j + 1) / 2);
    const float* const c = above + row * static_cast<std::size_t>(j / 2);
    const float* const d = above + row * static_cast<std::size_t>((j + 1) / 2);
#pragma GCC ivdep
    for (int i = 0; i < coarse.nx; ++i) line[i] = (a[i] + b[i]) + (c[i] + d[i]);
    const float* const from = x + fine.row() * static_cast<std::size_t>(j);
    float* const to = out + fine.row() * static_cast<std::size_t>(j);
    to[1] = from[1] + 0.125F * (line[0] + line[1]);
    const int pairs = (fine.nx - 3) / 2;  // of an even and an odd point
#pragma GCC ivdep
    for (int i = 1; i <= pairs; ++i) {
      to[2 * i] = from[2 * i] + 0.125F * (line[i] + line[i]);
      to[2 * i + 1] = from[2 * i + 1] + 0.125F * (line[i] + line[i + 1]);
    }
    const int last = fine.nx - 2;
    if (last % 2 == 0 && last > 1) to[last] = from[last] + 0.125F * (line[last / 2] + line[last / 2]);
  }
}

ESPDIFF_MULTIVERSION void turn_plane(float beta, const float* z, const float* from, std::size_t n, float* p) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + beta * from[i];
}

ESPDIFF_MULTIVERSION void add_products(const float* a, const float* b, std::size_t first, std::size_t last,
                                       LaneSums& sums) {
  constexpr std::size_t kLanes = LaneSums::kLanes;
  LaneSums own = sums;
  std::size_t i = first;
  for (; i < last && i % kLanes != 0; ++i) own.sum[i % kLanes] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  for (; i + kLanes <= last; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      own.sum[lane] += static_cast<double>(a[i + lane]) * static_cast<double>(b[i + lane]);
  }
  for (; i < last; ++i) own.sum[i % kLanes] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  sums = own;
}

double dot_run(const float* a, const float* b, std::size_t n) {
  LaneSums sums;
  add_products(a, b, 0, n, sums);
  return sums.total();
}

ESPDIFF_MULTIVERSION void advance_run(float alpha, const float* p, const float* q, std::size_t n, float* x, float* r) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    x[i] += alpha * p[i];
    r[i] -= alpha * q[i];
  }
}

ESPDIFF_MULTIVERSION void subtract_scaled_run(float alpha, const float* q, std::size_t n, float* r) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) r[i] -= alpha * q[i];
}

}  // namespace espdiff::ESPDIFF_BACKEND
