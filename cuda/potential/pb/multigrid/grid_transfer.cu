// grid_transfer.cu: restriction, interpolation, and the coarse grid's coefficients.
#include "cuda/potential/pb/multigrid/grid_transfer.h"

#include <algorithm>
#include <vector>

#include "cuda/potential/pb/multigrid/packed_operator.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Points of the next coarser grid along an axis. Its last point may lie one step beyond the finer grid.
int coarser(int n) { return n / 2 + 1; }

/// Two faces in series.
ESPDIFF_INLINE float in_series(float a, float b) { return 2.0F * a * b / (a + b); }

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

/// The sum of a point's six faces, in the order of add_faces_to_diagonal().
struct FacesOf {
  const float *ex, *ey, *ez;
  std::size_t row, plane;

  ESPDIFF_INLINE float operator()(std::size_t p) const {
    return (ex[p] + ex[p - 1]) + (ey[p] + ey[p - row]) + (ez[p] + ez[p - plane]);
  }
};
FacesOf faces_of(const GridOperator& a) { return {raw(a.ex), raw(a.ey), raw(a.ez), a.size.row(), a.size.plane()}; }

/// k is the diagonal minus the faces; it quadruples with the doubled spacing.
ESPDIFF_INLINE float coarse_k(float diagonal, float faces) { return 4.0F * larger(diagonal - faces, 0.0F); }

#if !defined(ESPDIFF_BACKEND_CUDA)
/// coarse_face() where all nine lines beside are inside: the same sum.
/// @param fine the finer face at the coarse one's point
/// @param along, side, other steps to the next point along the face's axis and the two that follow it
ESPDIFF_INLINE float inner_face(const float* fine, std::ptrdiff_t along, std::ptrdiff_t side, std::ptrdiff_t other) {
  float sum = 0;
  for (std::ptrdiff_t u = -1; u <= 1; ++u) {
    for (std::ptrdiff_t v = -1; v <= 1; ++v) {
      const float* const at = fine + u * side + v * other;
      sum += (u == 0 ? 2.0F : 1.0F) * (v == 0 ? 2.0F : 1.0F) * in_series(at[0], at[along]);
    }
  }
  return sum / 16.0F;
}

/// Coarse faces of the points 1 to n of a row. @param fine the finer row's first point
ESPDIFF_MULTIVERSION void inner_faces(const float* fine, std::ptrdiff_t along, std::ptrdiff_t side,
                                      std::ptrdiff_t other, int n, float* coarse) {
#pragma GCC ivdep
  for (int i = 1; i <= n; ++i) coarse[i] = inner_face(fine + 2 * std::ptrdiff_t{i}, along, side, other);
}

/// The coarse faces along an axis, row by row.
void coarsen_faces(const Buffer<float>& of_fine, const GridSize& f, const GridSize& c, int axis, Buffer<float>& faces) {
  const float* const fine = raw(of_fine);
  float* const coarse = raw(faces);
  const std::ptrdiff_t steps[3] = {1, static_cast<std::ptrdiff_t>(f.row()), static_cast<std::ptrdiff_t>(f.plane())};
  const std::ptrdiff_t along = steps[axis], side = steps[(axis + 1) % 3], other = steps[(axis + 2) % 3];
  const auto is_inner = [](int i, int n) { return i > 0 && 2 * i + 1 < n - 1; };
  const int n_inner = std::max(0, (f.nx - 1) / 2 - 1);  // inner points of a row, from the first
  for_each_index(static_cast<std::size_t>(c.ny) * static_cast<std::size_t>(c.nz), [=](std::size_t r) {
    const int j = static_cast<int>(r % static_cast<std::size_t>(c.ny)),
              k = static_cast<int>(r / static_cast<std::size_t>(c.ny));
    float* const row = coarse + c.index(0, j, k);
    const int n = is_inner(j, f.ny) && is_inner(k, f.nz) ? n_inner : 0;
    if (n > 0) inner_faces(fine + f.index(0, 2 * j, 2 * k), along, side, other, n, row);
    row[0] = coarse_face(fine, f, axis, 0, j, k);
    for (int i = n + 1; i < c.nx; ++i) row[i] = coarse_face(fine, f, axis, i, j, k);
  });
}

/// The coarse k from the fine grid's packed k.
void coarsen_packed_k(const GridOperator& fine, GridOperator& coarse) {
  const GridSize f = fine.size, c = coarse.size;
  const PackedView packed = fine.packed->view();
  const FacesOf faces_at = faces_of(fine);
  float* const out = raw(coarse.diagonal);
  for_each_index(static_cast<std::size_t>(c.nz), [=](std::size_t plane) {
    const int k = static_cast<int>(plane);
    std::fill_n(out + c.index(0, 0, k), c.plane(), 0.0F);
    if (k == 0 || 2 * k >= f.nz - 1) return;
    for (int j = 1; 2 * j < f.ny - 1; ++j) {
      const std::size_t row = f.index(0, 2 * j, 2 * k) / f.row();
      for (int i = 1; 2 * i < f.nx - 1; ++i) {
        const float faces = faces_at(f.index(2 * i, 2 * j, 2 * k));
        const bool has_ions = (packed.code_of(row, static_cast<std::uint32_t>(2 * i)) & MixedPoints::kIonsBit) != 0;
        const float own = has_ions ? packed.usual.ions : 0.0F;
        out[c.index(i, j, k)] = coarse_k(own + faces, faces);
      }
    }
  });
}
#endif

}  // namespace

// No coarse point's neighbours lie beyond the fine grid.
void restrict_to(const GridSize& fine, const Buffer<float>& r, const GridSize& coarse, Buffer<float>& b) {
  const float* const from = raw(r);
  float* const to = raw(b);
#if defined(ESPDIFF_BACKEND_CUDA)
  const std::size_t nx = static_cast<std::size_t>(coarse.nx - 2), ny = static_cast<std::size_t>(coarse.ny - 2);
  for_each_index(nx * ny * static_cast<std::size_t>(coarse.nz - 2), [=] ESPDIFF_HD(std::size_t index) {
    const int i = static_cast<int>(index % nx) + 1, j = static_cast<int>(index / nx % ny) + 1,
              k = static_cast<int>(index / (nx * ny)) + 1;
    const std::size_t row = fine.row(), plane = fine.plane();
    const float* const mid = from + fine.index(2 * i, 2 * j, 2 * k);
    const auto across = [&](const float* at) { return across_weighted(at - plane, at, at + plane, row); };
    to[coarse.index(i, j, k)] = along_weighted(across(mid - 1), across(mid), across(mid + 1));
  });
#else
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
#endif
}

void add_interpolated(const GridSize& coarse, const Buffer<float>& correction, const GridSize& fine, Buffer<float>& x) {
  const float* const from = raw(correction);
  float* const to = raw(x);
  const auto add = [=] ESPDIFF_HD(int i, int j, int k) {
    const int i0 = i / 2, i1 = (i + 1) / 2, j0 = j / 2, j1 = (j + 1) / 2, k0 = k / 2, k1 = (k + 1) / 2;
    const float* const a = from + coarse.index(0, j0, k0);
    const float* const b = from + coarse.index(0, j1, k0);
    const float* const c = from + coarse.index(0, j0, k1);
    const float* const d = from + coarse.index(0, j1, k1);
    to[fine.index(i, j, k)] += 0.125F * (((a[i0] + b[i0]) + (c[i0] + d[i0])) + ((a[i1] + b[i1]) + (c[i1] + d[i1])));
  };
  const std::size_t ny = static_cast<std::size_t>(fine.ny - 2), nz = static_cast<std::size_t>(fine.nz - 2);
#if defined(ESPDIFF_BACKEND_CUDA)
  const std::size_t nx = static_cast<std::size_t>(fine.nx - 2);
  for_each_index(nx * ny * nz, [=] ESPDIFF_HD(std::size_t index) {
    add(static_cast<int>(index % nx) + 1, static_cast<int>(index / nx % ny) + 1,
        static_cast<int>(index / (nx * ny)) + 1);
  });
#else
  for_each_index(ny * nz, [=](std::size_t index) {
    for (int i = 1; i < fine.nx - 1; ++i) add(i, static_cast<int>(index % ny) + 1, static_cast<int>(index / ny) + 1);
  });
#endif
}

float coarse_face_of_equal(float dielectric) {
  const GridSize size{5, 5, 5};
  const std::vector<float> faces(size.points(), dielectric);
  return coarse_face(faces.data(), size, 0, 1, 1, 1);
}

void coarsen(const GridOperator& fine, GridOperator& coarse) {
  const GridSize f = fine.size;
  const GridSize c{coarser(f.nx), coarser(f.ny), coarser(f.nz)};
  coarse.size = c;
  for (Buffer<float>* buffer : {&coarse.ex, &coarse.ey, &coarse.ez, &coarse.diagonal}) buffer->resize(c.points());
  const float* const of_points = fine.packed == nullptr ? raw(fine.diagonal) : nullptr;
#if defined(ESPDIFF_BACKEND_CUDA)
  const float* const fx = raw(fine.ex);
  const float* const fy = raw(fine.ey);
  const float* const fz = raw(fine.ez);
  float* const ex = raw(coarse.ex);
  float* const ey = raw(coarse.ey);
  float* const ez = raw(coarse.ez);
  for_each_index(c.points(), [=] ESPDIFF_HD(std::size_t p) {
    const int i = static_cast<int>(p % c.row()), j = static_cast<int>(p / c.row() % static_cast<std::size_t>(c.ny)),
              k = static_cast<int>(p / c.plane());
    ex[p] = coarse_face(fx, f, 0, i, j, k);
    ey[p] = coarse_face(fy, f, 1, i, j, k);
    ez[p] = coarse_face(fz, f, 2, i, j, k);
  });
#else
  coarsen_faces(fine.ex, f, c, 0, coarse.ex);
  coarsen_faces(fine.ey, f, c, 1, coarse.ey);
  coarsen_faces(fine.ez, f, c, 2, coarse.ez);
  if (of_points == nullptr) {
    coarsen_packed_k(fine, coarse);
    add_faces_to_diagonal(coarse);
    return;
  }
#endif
  const FacesOf faces_at = faces_of(fine);
  float* const diagonal = raw(coarse.diagonal);
  for_each_index(c.points(), [=] ESPDIFF_HD(std::size_t p) {
    const int i = static_cast<int>(p % c.row()), j = static_cast<int>(p / c.row() % static_cast<std::size_t>(c.ny)),
              k = static_cast<int>(p / c.plane());
    const std::size_t q = f.index(2 * i, 2 * j, 2 * k);
    const bool is_inner = i > 0 && j > 0 && k > 0 && 2 * i < f.nx - 1 && 2 * j < f.ny - 1 && 2 * k < f.nz - 1;
    diagonal[p] = is_inner ? coarse_k(of_points[q], faces_at(q)) : 0.0F;
  });
  add_faces_to_diagonal(coarse);
}

}  // namespace espdiff::ESPDIFF_BACKEND
