// surface_error.cu: points at the surface, and sums over them.
#include "cuda/potential/pb/surface_error.h"

#include <algorithm>
#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Of the planes of the grid one in so many is looked at: thousands of points are enough.
constexpr int kPlaneStride = 4;
constexpr float kLeastContrast = 2;

struct SurfaceRows {
  const float* ex;
  const float* ey;
  const float* ez;
  GridSize size;

  ESPDIFF_INLINE bool is_at_surface(std::size_t p) const {
    const std::size_t row = size.row(), plane = size.plane();
    const float low = smaller(smaller(smaller(ex[p], ex[p - 1]), smaller(ey[p], ey[p - row])),
                              smaller(ez[p], ez[p - plane])),
                high =
                    larger(larger(larger(ex[p], ex[p - 1]), larger(ey[p], ey[p - row])), larger(ez[p], ez[p - plane]));
    return high >= kLeastContrast * low;
  }
  /// Calls found(point) for the points at the surface of the index'th row.
  template <typename Found>
  ESPDIFF_INLINE void visit(std::size_t index, const Found& found) const {
    const std::size_t inner = static_cast<std::size_t>(size.ny - 2);
    const std::size_t first =
        size.index(0, static_cast<int>(index % inner) + 1, static_cast<int>(index / inner) * kPlaneStride + 1);
    for (std::size_t p = first + 1; p + 1 < first + size.row(); ++p) {
      if (is_at_surface(p)) found(static_cast<std::uint32_t>(p));
    }
  }
};

struct ChangeSums {
  double change = 0, value = 0;  ///< sums of squares
  ESPDIFF_INLINE void operator+=(const ChangeSums& other) {
    change += other.change;
    value += other.value;
  }
};

Buffer<std::uint32_t> points_at_surface(const GridOperator& on_grid) {
  const GridSize size = on_grid.size;
  const SurfaceRows rows{raw(on_grid.ex), raw(on_grid.ey), raw(on_grid.ez), size};
  const std::size_t n_rows =
      static_cast<std::size_t>(size.ny - 2) * static_cast<std::size_t>((size.nz - 2 + kPlaneStride - 1) / kPlaneStride);
  Buffer<std::uint32_t> first(n_rows);
  std::uint32_t* const place = raw(first);
  for_each_index(n_rows, [=] ESPDIFF_HD(std::size_t row) {
    std::uint32_t n = 0;
    rows.visit(row, [&](std::uint32_t) { ++n; });
    place[row] = n;
  });
  Buffer<std::uint32_t> points(exclusive_scan_in_place(first));
  std::uint32_t* const out = raw(points);
  for_each_index(n_rows, [=] ESPDIFF_HD(std::size_t row) {
    std::uint32_t next = place[row];
    rows.visit(row, [&](std::uint32_t p) { out[next++] = p; });
  });
  return points;
}

/// sum over the points of (alpha p)^2 and x^2.
ChangeSums sum_changes(const Buffer<std::uint32_t>& points, float alpha, const Buffer<float>& p,
                       const Buffer<float>& x) {
  const std::uint32_t* const point = raw(points);
  const float* const along = raw(p);
  const float* const position = raw(x);
  return sum_over<ChangeSums>(points.size(), [=] ESPDIFF_HD(std::size_t i) {
    const double change = static_cast<double>(alpha) * static_cast<double>(along[point[i]]),
                 value = static_cast<double>(position[point[i]]);
    return ChangeSums{change * change, value * value};
  });
}

}  // namespace

SurfaceError::SurfaceError(const GridOperator& on_grid) : points_(points_at_surface(on_grid)) {}

double SurfaceError::after_cycle(float alpha, const Buffer<float>& p, const Buffer<float>& x) {
  const ChangeSums sums = sum_changes(points_, alpha, p, x);
  const double change = std::sqrt(sums.change / sums.value);
  // Of two cycles, since single ones differ; the first ones of a solution count as halving.
  constexpr double kFirst = 0.5, kLeast = 0.2, kMost = 0.9;
  const double q = before_last_ > 0 ? std::max(kLeast, std::min(kMost, std::sqrt(change / before_last_))) : kFirst;
  before_last_ = last_;
  last_ = change;
  return change * q / (1 - q);
}

}  // namespace espdiff::ESPDIFF_BACKEND
