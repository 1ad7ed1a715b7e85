// plane_sweeps.cu: passes in which the loops over planes follow each other.
#include "cuda/potential/pb/multigrid/plane_sweeps.h"

#include <omp.h>

#include <algorithm>

#include "cuda/potential/pb/multigrid/plane_loops.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Planes of a range below which another thread would not pay.
constexpr int kFewestPlanes = 8;

/// Zeroes the border of a plane of a grid.
void clear_border(const GridSize& size, float* plane) {
  std::fill_n(plane, size.row(), 0.0F);
  std::fill_n(plane + size.plane() - size.row(), size.row(), 0.0F);
  for (std::size_t first = size.row(); first < size.plane(); first += size.row())
    plane[first] = plane[first + size.row() - 1] = 0.0F;
}

int n_ranges(const GridSize& size) {
  if (size.points() < kSerialPoints) return 1;
  return std::max(1, std::min(omp_get_max_threads(), (size.nz - 2) / kFewestPlanes));
}

/// The range'th of n parts of [first, last).
struct Part {
  int first, last;
};
Part part_of(int first, int last, int range, int n) {
  const auto at = [&](int r) { return first + static_cast<int>(static_cast<long>(last - first) * r / n); };
  return {at(range), at(range + 1)};
}

/// Points of a plane's strip. A pass holds up to 25 planes of them, 2 MB: larger planes are swept strip by strip.
constexpr std::size_t kStripPoints = 20480;
constexpr int kFewestRows = 8;  // of a strip: neighbouring rows are computed again

/// Strips of the rows [first, last) of planes, the same at any number of threads.
std::vector<RowRange> strips_of(int first, int last, std::size_t points_in_row) {
  const std::size_t points = points_in_row * static_cast<std::size_t>(last - first);
  const int n =
      std::max(1, std::min(static_cast<int>((points + kStripPoints - 1) / kStripPoints), (last - first) / kFewestRows));
  std::vector<RowRange> strips;
  for (int i = 0; i < n; ++i) {
    const Part part = part_of(first, last, i, n);
    strips.push_back({part.first, part.last});
  }
  return strips;
}

/// The strip and its neighbouring rows, without the border.
RowRange with_halo(const GridSize& size, RowRange strip, int halo) {
  return {std::max(1, strip.first - halo), std::min(size.ny - 1, strip.last + halo)};
}

double total_of(const std::vector<LaneSums>& of_plane) {
  double total = 0;
  for (const LaneSums& sums : of_plane) total += sums.total();
  return total;
}
double total_of(const std::vector<double>& of_plane) {
  double total = 0;
  for (const double sum : of_plane) total += sum;
  return total;
}

}  // namespace

PlaneSweeps::PlaneSweeps(const GridSize& largest) : own_(static_cast<std::size_t>(n_ranges(largest))) {
  for (Own& own : own_) {
    own.zero.assign(largest.plane(), 0.0F);
    for (auto* planes : {&own.x, &own.black, &own.r}) {
      for (Buffer<float>& plane : *planes) plane.assign(largest.plane(), 0.0F);
    }
    for (Buffer<float>& plane : own.halo) plane.assign(largest.plane(), 0.0F);
    own.row.assign(largest.row(), 0.0F);
  }
}

void PlaneSweeps::smooth_and_restrict(const GridOperator& a, const Buffer<float>& b, Buffer<float>& x,
                                      const GridSize& coarse, Buffer<float>& coarse_b) {
  const GridSize size = a.size;
  const std::size_t plane = size.plane(), row = size.row();
  const int n = std::min(n_ranges(size), static_cast<int>(own_.size()));
  const float* const right = raw(b);
  float* const out = raw(x);
  float* const restricted = raw(coarse_b);
  const std::vector<RowRange> strips = strips_of(1, coarse.ny - 1, 2 * row);  // of coarse rows
  const auto sweep_strip = [&, n](std::size_t range, RowRange strip) {
    Own& own = own_[range];
    const RowRange fine{strip.first == 1 ? 1 : 2 * strip.first - 1,
                        strip.last == coarse.ny - 1 ? size.ny - 1 : 2 * strip.last - 1};
    const RowRange restricting{2 * strip.first - 1, std::max(2 * strip.last, fine.last)};
    const RowRange of_r = with_halo(size, restricting, 0), of_black = with_halo(size, restricting, 1),
                   of_x = with_halo(size, restricting, 2);
    OperatorRows rows(a, own.coefficients, PlainEnds::kLeftOut, of_x);
    const Part part = part_of(1, coarse.nz - 1, static_cast<int>(range), n);  // of coarse planes
    const int first = range == 0 ? 1 : 2 * part.first - 1,
              last = static_cast<int>(range) == n - 1 ? size.nz - 1 : 2 * part.last - 1;
    const auto is_inner = [&](int k) { return k > 0 && k < size.nz - 1; };
    const auto x_of = [&](int k) { return is_inner(k) ? raw(own.x[k % 3]) : raw(own.zero); };
    const auto black_of = [&](int k) { return is_inner(k) ? raw(own.black[k % 3]) : raw(own.zero); };
    const auto r_of = [&](int k) { return is_inner(k) ? raw(own.r[k % 3]) : raw(own.zero); };
    const auto b_of = [&](int k) { return right + plane * static_cast<std::size_t>(k); };
    const std::size_t fine_first = row * static_cast<std::size_t>(fine.first),
                      fine_points = row * static_cast<std::size_t>(fine.last - fine.first);
    const int lowest = 2 * part.first - 3, highest = std::max(2 * part.last - 1, last);
    for (int k = std::max(1, lowest); k <= highest + 2; ++k) {
      if (is_inner(k)) start_plane(rows, size, k, of_x, b_of(k), x_of(k));
      const int black = k - 1, done = k - 2;
      if (is_inner(black) && black > lowest)
        sweep_plane(rows, size, black, of_black, 1, b_of(black), {x_of(black - 1), x_of(black), x_of(black + 1)},
                    black_of(black));
      if (done < 1 || done < lowest + 2) continue;
      if (is_inner(done)) {
        residual_plane(rows, size, done, of_r, {black_of(done - 1), black_of(done), black_of(done + 1)}, r_of(done));
        if (done >= first && done < last)
          std::copy_n(black_of(done) + fine_first, fine_points,
                      out + plane * static_cast<std::size_t>(done) + fine_first);
      }
      const int to = (done - 1) / 2;
      if (done % 2 == 1 && to >= part.first && to < part.last)
        restrict_plane(size, {r_of(done - 2), r_of(done - 1), r_of(done)}, coarse, strip, raw(own.row),
                       restricted + coarse.plane() * static_cast<std::size_t>(to));
    }
  };
  for_each_index(static_cast<std::size_t>(n), [&](std::size_t range) {
    // Border rows of these planes stay zero, whatever the level's size.
    Own& own = own_[range];
    for (auto* planes : {&own.x, &own.black, &own.r}) {
      for (Buffer<float>& buffer : *planes) clear_border(size, raw(buffer));
    }
    for (const RowRange& strip : strips) sweep_strip(range, strip);
  });
}

double PlaneSweeps::correct_and_smooth(const GridOperator& a, const Buffer<float>& b, const GridSize& coarse,
                                       const Buffer<float>& correction, Buffer<float>& x) {
  const GridSize size = a.size;
  const std::size_t plane = size.plane(), row = size.row();
  const int n = std::min(n_ranges(size), static_cast<int>(own_.size()));
  const float* const right = raw(b);
  const float* const from = raw(correction);
  float* const out = raw(x);
  const auto is_inner = [&](int k) { return k > 0 && k < size.nz - 1; };
  const auto part_of_range = [&](std::size_t range) { return part_of(1, size.nz - 1, static_cast<int>(range), n); };
  // Neighbours' planes, before they are overwritten.
  for (std::size_t range = 0; range < static_cast<std::size_t>(n); ++range) {
    const Part part = part_of_range(range);
    for (int side = 0; side < 4; ++side) {
      const int k = side < 2 ? part.first - 2 + side : part.last + side - 2;
      if (is_inner(k)) std::copy_n(out + plane * static_cast<std::size_t>(k), plane, raw(own_[range].halo[side]));
    }
  }
  std::vector<LaneSums> products(static_cast<std::size_t>(size.nz));
  const std::vector<RowRange> strips = strips_of(1, size.ny - 1, row);
  const auto sweep_strip = [&](std::size_t range, RowRange strip) {
    Own& own = own_[range];
    const RowRange of_x = with_halo(size, strip, 2), of_black = with_halo(size, strip, 1);
    OperatorRows rows(a, own.coefficients, PlainEnds::kLeftOut, of_black);
    const Part part = part_of_range(range);
    const auto x_of = [&](int k) { return is_inner(k) ? raw(own.x[k % 3]) : raw(own.zero); };
    const auto black_of = [&](int k) { return is_inner(k) ? raw(own.black[k % 3]) : raw(own.zero); };
    const auto b_of = [&](int k) { return right + plane * static_cast<std::size_t>(k); };
    const auto before = [&](int k) -> const float* {
      if (k < part.first) return raw(own.halo[k - part.first + 2]);
      return k < part.last ? out + plane * static_cast<std::size_t>(k) : raw(own.halo[k - part.last + 2]);
    };
    const auto coarse_of = [&](int k) { return from + coarse.plane() * static_cast<std::size_t>(k); };
    const auto interpolate = [&](int k, RowRange of, const float* x_before) {
      interpolate_plane(coarse, coarse_of(k / 2), coarse_of((k + 1) / 2), size, of, x_before, raw(own.row), x_of(k));
    };
    const std::size_t first = row * static_cast<std::size_t>(strip.first),
                      last = row * static_cast<std::size_t>(strip.last);
    for (int k = part.first - 2; k < part.last + 2; ++k) {
      if (is_inner(k) && (k < part.first || k >= part.last)) {
        interpolate(k, of_x, before(k));
      } else if (is_inner(k)) {
        // The strip before has overwritten its last two rows.
        float* const saved = raw(own.saved) + 2 * row * static_cast<std::size_t>(k - part.first);
        if (strip.first > 1)
          interpolate(k, {of_x.first, strip.first}, saved - row * static_cast<std::size_t>(of_x.first));
        interpolate(k, {strip.first, of_x.last}, before(k));
        if (strip.last < size.ny - 1) std::copy_n(before(k) + last - 2 * row, 2 * row, saved);
      }
      const int black = k - 1, red = k - 2;
      if (is_inner(black) && black >= part.first - 1)
        sweep_plane(rows, size, black, of_black, 1, b_of(black), {x_of(black - 1), x_of(black), x_of(black + 1)},
                    black_of(black));
      if (red < part.first || red >= part.last) continue;
      float* const done = out + plane * static_cast<std::size_t>(red);
      sweep_plane(rows, size, red, strip, 0, b_of(red), {black_of(red - 1), black_of(red), black_of(red + 1)}, done);
      add_products(done, b_of(red), first, last, products[static_cast<std::size_t>(red)]);
    }
  };
  for_each_index(static_cast<std::size_t>(n), [&](std::size_t range) {
    Own& own = own_[range];
    for (auto* planes : {&own.x, &own.black}) {
      for (Buffer<float>& buffer : *planes) clear_border(size, raw(buffer));
    }
    const Part part = part_of_range(range);
    own.saved.resize(strips.size() == 1 ? 0 : 2 * row * static_cast<std::size_t>(part.last - part.first));
    for (const RowRange& strip : strips) sweep_strip(range, strip);
  });
  return total_of(products);
}

double PlaneSweeps::turn_and_apply(const GridOperator& a, float beta, Products form, Buffer<float>& z,
                                   Buffer<float>& p) {
  const GridSize size = a.size;
  const std::size_t plane = size.plane(), row = size.row();
  const int n = std::min(n_ranges(size), static_cast<int>(own_.size()));
  float* const along = raw(p);
  float* const image = raw(z);
  const auto at = [&](int k) { return plane * static_cast<std::size_t>(k); };
  const auto part_of_range = [&](std::size_t range) { return part_of(1, size.nz - 1, static_cast<int>(range), n); };
  // The neighbours' new p, before z and p are overwritten. Those of the grid's border are zero.
  for (std::size_t range = 0; range < static_cast<std::size_t>(n); ++range) {
    const Part part = part_of_range(range);
    turn_plane(beta, image + at(part.first - 1), along + at(part.first - 1), plane, raw(own_[range].halo[0]));
    turn_plane(beta, image + at(part.last), along + at(part.last), plane, raw(own_[range].halo[1]));
  }
  std::vector<LaneSums> products(static_cast<std::size_t>(size.nz));
  const std::vector<RowRange> strips = strips_of(1, size.ny - 1, row);
  const auto apply_strip = [&](std::size_t range, RowRange strip) {
    Own& own = own_[range];
    OperatorRows rows(a, own.coefficients, form == Products::kExact ? PlainEnds::kUnpacked : PlainEnds::kLeftOut,
                      strip);
    const Part part = part_of_range(range);
    const auto p_of = [&](int k) -> const float* {
      if (k < part.first) return raw(own.halo[0]);
      return k < part.last ? along + at(k) : raw(own.halo[1]);
    };
    const std::size_t first = row * static_cast<std::size_t>(strip.first),
                      last = row * static_cast<std::size_t>(strip.last);
    // A strip needs the next one's first row of p, and has that of the one before.
    const std::size_t turned = strip.first == 1 ? 0 : first + row, n_turned = last + row - turned;
    for (int k = part.first; k <= part.last; ++k) {
      if (k < part.last) {
        float* const own_p = along + at(k) + turned;
        turn_plane(beta, image + at(k) + turned, own_p, n_turned, own_p);
      }
      const int done = k - 1;
      if (done < part.first) continue;
      apply_plane(rows, size, done, strip, form, {p_of(done - 1), p_of(done), p_of(done + 1)}, image + at(done));
      add_products(along + at(done), image + at(done), first, last, products[static_cast<std::size_t>(done)]);
    }
  };
  for_each_index(static_cast<std::size_t>(n), [&](std::size_t range) {
    for (const RowRange& strip : strips) apply_strip(range, strip);
  });
  return total_of(products);
}

void subtract_exactly_by_rows(const GridOperator& a, const Buffer<float>& x, const Buffer<float>& low,
                              Buffer<float>& r) {
  const std::size_t plane = a.size.plane();
  const float* const high = raw(x);
  const float* const rest = low.empty() ? nullptr : raw(low);
  float* const residual = raw(r);
  const int n = n_ranges(a.size);
  for_each_index(static_cast<std::size_t>(n), [&, n](std::size_t range) {
    Buffer<float> coefficients;
    OperatorRows rows(a, coefficients, PlainEnds::kUnpacked);
    const Part part = part_of(1, a.size.nz - 1, static_cast<int>(range), n);
    for (int k = part.first; k < part.last; ++k) {
      const std::size_t first = plane * static_cast<std::size_t>(k);
      subtract_exactly_plane(rows, a.size, k, high + first, rest == nullptr ? nullptr : rest + first, residual + first);
    }
  });
}

double advance_by_runs(float alpha, const float* p, const float* q, float* x, Buffer<float>& r) {
  constexpr std::size_t kRun = 16384;
  const std::size_t n = r.size(), n_runs = (n + kRun - 1) / kRun;
  std::vector<double> squares(n_runs, 0.0);
  float* const residual = raw(r);
  double* const of_run = squares.data();
  for_each_index(n_runs, [=](std::size_t run) {
    const std::size_t first = run * kRun, length = std::min(kRun, n - first);
    if (x != nullptr) {
      advance_run(alpha, p + first, q + first, length, x + first, residual + first);
    } else {
      subtract_scaled_run(alpha, q + first, length, residual + first);
    }
    of_run[run] = dot_run(residual + first, residual + first, length);
  });
  return total_of(squares);
}

}  // namespace espdiff::ESPDIFF_BACKEND
