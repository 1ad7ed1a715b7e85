// spread.cu: sorts charges into rows of the grid and spreads them, by slabs (CPU) or by points (device).
#include "cuda/potential/spread.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "cuda/device/sort.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// A total order of charges, by base_x first, because the gather searches for it.
struct InOrder {
  ESPDIFF_HD bool operator()(const GridCharge& a, const GridCharge& b) const {
    if (a.row != b.row) return a.row < b.row;
    if (a.base_x != b.base_x) return a.base_x < b.base_x;
    for (int axis = 0; axis < 3; ++axis) {
      if (a.u[axis] != b.u[axis]) return a.u[axis] < b.u[axis];
    }
    return a.charge < b.charge;
  }
};

ESPDIFF_INLINE void set_base(GridCharge& c, int order, int nx, int ny, int nz) {
  const int y = spline_place(c.u[1], order, ny).base, z = spline_place(c.u[2], order, nz).base;
  c.row = c.charge == 0 ? static_cast<std::uint32_t>(ny) * static_cast<std::uint32_t>(nz)  // of no row
                        : static_cast<std::uint32_t>(y + ny * z);
  c.base_x = spline_place(c.u[0], order, nx).base;
}

/// Sets the charges' bases and row_first; returns the charges in order, those of no row last or left out.
#if defined(ESPDIFF_BACKEND_CUDA)

/// Within a row: ascending as InOrder is, though not always where that is.
ESPDIFF_INLINE std::uint32_t key_in_row(const GridCharge& c, int nx) {
  constexpr int kPlaceBits = 20;  // the others hold base_x, below 4096
  constexpr double kPlaces = 1 << kPlaceBits;
  return static_cast<std::uint32_t>(c.base_x) << kPlaceBits |
         static_cast<std::uint32_t>(c.u[0] / static_cast<double>(nx) * kPlaces);
}

/// Restores a heap of items, by the charges that they name, whose item `from` may be less than those below it.
ESPDIFF_INLINE void sink(std::uint32_t* item, std::size_t from, std::size_t end, const GridCharge* charge) {
  const InOrder before;
  for (std::size_t child = 2 * from + 1; child < end; child = 2 * from + 1) {
    if (child + 1 < end && before(charge[item[child]], charge[item[child + 1]])) ++child;
    if (!before(charge[item[from]], charge[item[child]])) return;
    const std::uint32_t larger = item[child];
    item[child] = item[from];
    item[from] = larger;
    from = child;
  }
}

/// Sorts n items by the charges that they name; all of them may lie at one place.
ESPDIFF_INLINE void heap_sort(std::uint32_t* item, std::size_t n, const GridCharge* charge) {
  for (std::size_t i = n / 2; i-- > 0;) sink(item, i, n, charge);
  for (std::size_t end = n; end-- > 1;) {
    const std::uint32_t largest = item[0];
    item[0] = item[end];
    item[end] = largest;
    sink(item, 0, end, charge);
  }
}

/// Puts charges of equal keys, which follow each other, into their order.
void sort_equal_keys(const Buffer<GridCharge>& charges, int nx, std::size_t n_rows, Buffer<std::uint32_t>& items) {
  const std::size_t n = items.size();
  Buffer<std::uint8_t> begins(n);
  std::uint8_t* const begin = raw(begins);
  std::uint32_t* const item = raw(items);
  const GridCharge* const charge = raw(charges);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    const GridCharge& c = charge[item[i]];
    const GridCharge& last = charge[item[i == 0 ? 0 : i - 1]];
    begin[i] = i == 0 || c.row >= n_rows || c.row != last.row || key_in_row(c, nx) != key_in_row(last, nx) ? 1 : 0;
  });
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    if (begin[i] == 0) return;
    std::size_t end = i + 1;
    while (end < n && begin[end] == 0) ++end;
    if (end > i + 1) heap_sort(item + i, end - i, charge);
  });
}

Buffer<GridCharge> sort_by_rows(Buffer<GridCharge> charges, const std::array<int, 3>& size, int order,
                                Buffer<std::uint32_t>& row_first) {
  const std::size_t n = charges.size(), n_rows = static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  Buffer<std::uint32_t> keys(n), items(n);
  std::uint32_t* const key = raw(keys);
  std::uint32_t* const item = raw(items);
  GridCharge* const charge = raw(charges);
  const int nx = size[0], ny = size[1], nz = size[2];
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    set_base(charge[i], order, nx, ny, nz);
    key[i] = key_in_row(charge[i], nx);
    item[i] = static_cast<std::uint32_t>(i);
  });
  constexpr int kAllBits = 32;
  sort_by_key(keys, items, kAllBits);
  // The buffers may have been exchanged.
  std::uint32_t* const row = raw(keys);
  const std::uint32_t* const by_x = raw(items);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) { row[i] = charge[by_x[i]].row; });
  sort_by_key(keys, items, bits_below(n_rows + 1));
  sort_equal_keys(charges, nx, n_rows, items);
  Buffer<GridCharge> sorted(n);
  GridCharge* const to = raw(sorted);
  const std::uint32_t* const from = raw(items);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) { to[i] = charge[from[i]]; });
  row_first = first_of_rows(n, n_rows, [=] ESPDIFF_HD(std::size_t i) { return std::size_t{to[i].row}; });
  return sorted;
}

#else

// Counting sort by row, then the few charges of each row by comparison.
Buffer<GridCharge> sort_by_rows(Buffer<GridCharge> charges, const std::array<int, 3>& size, int order,
                                Buffer<std::uint32_t>& row_first) {
  const std::size_t n_rows = static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  row_first.assign(n_rows + 1, 0);
  std::uint32_t* const rows = raw(row_first);
  for (GridCharge& c : charges) {
    set_base(c, order, size[0], size[1], size[2]);
    if (c.row < n_rows) ++rows[c.row + 1];
  }
  for (std::size_t r = 1; r < row_first.size(); ++r) rows[r] += rows[r - 1];
  std::vector<std::uint32_t> next(rows, rows + n_rows);
  Buffer<GridCharge> sorted(rows[n_rows]);
  GridCharge* const first = sorted.data();
  for (const GridCharge& c : charges) {
    if (c.row < n_rows) first[next[c.row]++] = c;
  }
  for_each_index(n_rows, [=](std::size_t r) { std::sort(first + rows[r], first + rows[r + 1], InOrder()); });
  return sorted;
}

#endif

template <int Order, typename T>
void store_weights(const Buffer<GridCharge>& sorted, SortedCharges<T>& charges) {
  constexpr int kStored = kStoredWeights<Order>;
  const GridCharge* const atoms = raw(sorted);
  charges.base_x.resize(sorted.size());
  charges.weights.resize(sorted.size() * 3 * kStored);
  int* const base_x = raw(charges.base_x);
  T* const weights = raw(charges.weights);
  const int nx = charges.size[0], ny = charges.size[1], nz = charges.size[2];
  for_each_index(sorted.size(), [=] ESPDIFF_HD(std::size_t i) {
    const int size[3] = {nx, ny, nz};
    T* const own = weights + i * 3 * kStored;
    for (int axis = 0; axis < 3; ++axis) {
      const SplinePlace place = spline_place(atoms[i].u[axis], Order, size[axis]);
      if (axis == 0) base_x[i] = place.base;
      spline_weights<Order>(static_cast<T>(place.part), own + axis * kStored);
    }
    for (int j = 0; j < kStored; ++j) own[2 * kStored + j] *= static_cast<T>(atoms[i].charge);
  });
}

/// Sorted charges for kernels.
template <typename T>
struct ChargesView {
  const std::uint32_t* row_first;
  const int* base_x;
  const T* weights;
  int size[3];
};
template <typename T>
ChargesView<T> view_of(const SortedCharges<T>& c) {
  return {raw(c.row_first), raw(c.base_x), raw(c.weights), {c.size[0], c.size[1], c.size[2]}};
}

#if defined(__GNUC__) && !defined(__CUDACC__)
/// N numbers, added by one instruction where the processor has it. Compilers do not vectorize such short loops.
template <typename T, int N>
struct Lanes {
  typedef T Type __attribute__((vector_size(N * sizeof(T))));
};
/// line[k] += factor * weights[k], k from 0 to N - 1.
template <int N, typename T>
ESPDIFF_INLINE void add_line(T* line, const T* weights, T factor) {
  typename Lanes<T, N>::Type sum, weight;
  std::memcpy(&sum, line, sizeof sum);
  std::memcpy(&weight, weights, sizeof weight);
  sum += factor * weight;
  std::memcpy(line, &sum, sizeof sum);
}
#else
template <int N, typename T>
ESPDIFF_INLINE void add_line(T* line, const T* weights, T factor) {
  for (int k = 0; k < N; ++k) line[k] += factor * weights[k];
}
#endif

/// Adds one charge's part of a slab: `factor` is its weight along z.
template <int Order, typename T>
ESPDIFF_INLINE void add_to_slab(const ChargesView<T>& charges, T* slab, int base_x, int base_y, const T* weights,
                                T factor) {
  constexpr int kStored = kStoredWeights<Order>;
  const int nx = charges.size[0], ny = charges.size[1];
  const T* const wy = weights + kStored;
  const bool is_whole = base_x + kStored <= nx;
  for (int j = 0; j < Order; ++j) {
    const int y = base_y + j < ny ? base_y + j : base_y + j - ny;
    T* const line = slab + static_cast<std::size_t>(y) * static_cast<std::size_t>(nx);
    const T row_factor = factor * wy[j];
    if (is_whole) {
      // Whole vectors: the weights beyond the order are zero and change nothing.
      add_line<kStored>(line + base_x, weights, row_factor);
    } else {
      for (int k = 0; k < Order; ++k) line[base_x + k < nx ? base_x + k : base_x + k - nx] += row_factor * weights[k];
    }
  }
}

template <int Order, typename T>
ESPDIFF_INLINE void fill_slab_inline(const ChargesView<T>& charges, int z, T* slab) {
  constexpr int kStored = kStoredWeights<Order>;
  const int nx = charges.size[0], ny = charges.size[1], nz = charges.size[2];
  const std::size_t n_points = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  for (std::size_t i = 0; i < n_points; ++i) slab[i] = T(0);
  for (int dz = 0; dz < Order; ++dz) {
    const int base_z = z >= dz ? z - dz : z - dz + nz;
    const std::uint32_t* const rows =
        charges.row_first + static_cast<std::size_t>(ny) * static_cast<std::size_t>(base_z);
    for (int base_y = 0; base_y < ny; ++base_y) {
      for (std::uint32_t i = rows[base_y]; i < rows[base_y + 1]; ++i) {
        const T* const own = charges.weights + static_cast<std::size_t>(i) * 3 * kStored;
        add_to_slab<Order>(charges, slab, charges.base_x[i], base_y, own, own[2 * kStored + dz]);
      }
    }
  }
}

#if !defined(__CUDACC__)
// Not a template: only plain functions can be compiled for several instruction sets.
// NOLINTBEGIN(bugprone-macro-parentheses): a type takes none.
#define ESPDIFF_FILL_SLAB(order, type)                                                                             \
  ESPDIFF_MULTIVERSION void fill_slab(std::integral_constant<int, order>, const ChargesView<type>& charges, int z, \
                                      type* slab) {                                                                \
    fill_slab_inline<order>(charges, z, slab);                                                                     \
  }
// NOLINTEND(bugprone-macro-parentheses)
ESPDIFF_FILL_SLAB(4, float)
ESPDIFF_FILL_SLAB(5, float)
ESPDIFF_FILL_SLAB(6, float)
ESPDIFF_FILL_SLAB(7, float)
ESPDIFF_FILL_SLAB(8, float)
ESPDIFF_FILL_SLAB(4, double)
ESPDIFF_FILL_SLAB(5, double)
ESPDIFF_FILL_SLAB(6, double)
ESPDIFF_FILL_SLAB(7, double)
ESPDIFF_FILL_SLAB(8, double)
#undef ESPDIFF_FILL_SLAB
#else
template <int Order, typename T>
ESPDIFF_INLINE void fill_slab(std::integral_constant<int, Order>, const ChargesView<T>& charges, int z, T* slab) {
  fill_slab_inline<Order>(charges, z, slab);
}
#endif

/// Adds the charges first to last - 1 of a row whose base lies in [low, high] to the sum of a grid point; they are
/// ascending in the base.
template <int Order, typename T>
ESPDIFF_INLINE void add_bases(const ChargesView<T>& charges, std::uint32_t first, std::uint32_t last, int low, int high,
                              int x, int dy, int dz, T& sum) {
  constexpr int kStored = kStoredWeights<Order>;
  std::uint32_t end = last;
  while (first < end) {  // the first whose base is not below
    const std::uint32_t middle = first + (end - first) / 2;
    if (charges.base_x[middle] < low) {
      first = middle + 1;
    } else {
      end = middle;
    }
  }
  for (std::uint32_t i = first; i < last && charges.base_x[i] <= high; ++i) {
    const int base = charges.base_x[i], dx = x >= base ? x - base : x - base + charges.size[0];
    const T* const own = charges.weights + static_cast<std::size_t>(i) * 3 * kStored;
    sum += own[2 * kStored + dz] * own[kStored + dy] * own[dx];
  }
}

template <int Order, typename T>
ESPDIFF_INLINE T gather_point(const ChargesView<T>& charges, int x, int y, int z) {
  const int nx = charges.size[0], ny = charges.size[1], nz = charges.size[2];
  T sum = T(0);
  for (int dz = 0; dz < Order; ++dz) {
    const int base_z = z >= dz ? z - dz : z - dz + nz;
    for (int step = 0; step < Order; ++step) {  // bases along y in ascending order, also where they wrap
      int base_y = y - Order + 1 + step;
      if (y < Order - 1) base_y = step <= y ? step : ny - Order + step;
      const int dy = y >= base_y ? y - base_y : y - base_y + ny;
      const std::uint32_t* const row = charges.row_first + static_cast<std::size_t>(base_y) +
                                       static_cast<std::size_t>(ny) * static_cast<std::size_t>(base_z);
      const int low = x - Order + 1;
      add_bases<Order>(charges, row[0], row[1], low < 0 ? 0 : low, x, x, dy, dz, sum);
      if (low < 0) add_bases<Order>(charges, row[0], row[1], low + nx, nx - 1, x, dy, dz, sum);
    }
  }
  return sum;
}

/// Calls body(std::integral_constant<int, order>()) and nothing else: device lambdas may not be generic.
template <int Order, typename T>
void spread_points_of_order(const SortedCharges<T>& charges, T* values, std::size_t slab_stride) {
  const ChargesView<T> view = view_of(charges);
  const std::size_t nx = static_cast<std::size_t>(charges.size[0]), ny = static_cast<std::size_t>(charges.size[1]),
                    nz = static_cast<std::size_t>(charges.size[2]);
  for_each_index(nx * ny * nz, [=] ESPDIFF_HD(std::size_t i) {
    const std::size_t x = i % nx, y = i / nx % ny, z = i / (nx * ny);
    values[x + nx * y + slab_stride * z] =
        gather_point<Order>(view, static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
  });
}

template <int Order>
void spread_rounded_of_order(const SortedCharges<double>& charges, float* values) {
  const ChargesView<double> view = view_of(charges);
  const std::size_t nx = static_cast<std::size_t>(charges.size[0]), ny = static_cast<std::size_t>(charges.size[1]),
                    nz = static_cast<std::size_t>(charges.size[2]);
#if defined(ESPDIFF_BACKEND_CUDA)
  for_each_index(nx * ny * nz, [=] ESPDIFF_HD(std::size_t i) {
    values[i] = static_cast<float>(gather_point<Order>(view, static_cast<int>(i % nx), static_cast<int>(i / nx % ny),
                                                       static_cast<int>(i / (nx * ny))));
  });
#else
  for_each_index(nz, [=](std::size_t z) {
    std::vector<double> slab(nx * ny);
    fill_slab(std::integral_constant<int, Order>(), view, static_cast<int>(z), slab.data());
    std::transform(slab.begin(), slab.end(), values + z * slab.size(),
                   [](double value) { return static_cast<float>(value); });
  });
#endif
}

template <int Order, typename T>
void spread_slabs_of_order(const SortedCharges<T>& charges, T* values, std::size_t slab_stride) {
  const ChargesView<T> view = view_of(charges);
  for_each_index(static_cast<std::size_t>(charges.size[2]), [=] ESPDIFF_HD(std::size_t z) {
    fill_slab(std::integral_constant<int, Order>(), view, static_cast<int>(z), values + z * slab_stride);
  });
}

}  // namespace

template <typename T>
SortedCharges<T> sort_charges(Buffer<GridCharge> charges, std::array<int, 3> size, int order) {
  SortedCharges<T> result;
  result.order = order;
  result.size = size;
  const Buffer<GridCharge> sorted = sort_by_rows(std::move(charges), size, order, result.row_first);
  with_spline_order(order, [&](auto constant) { store_weights<decltype(constant)::value>(sorted, result); });
  return result;
}

template <typename T>
void spread_by_slabs(const SortedCharges<T>& charges, T* values, std::size_t slab_stride) {
  with_spline_order(charges.order, [&](auto constant) {
    spread_slabs_of_order<decltype(constant)::value>(charges, values, slab_stride);
  });
}
template <typename T>
void spread_by_points(const SortedCharges<T>& charges, T* values, std::size_t slab_stride) {
  with_spline_order(charges.order, [&](auto constant) {
    spread_points_of_order<decltype(constant)::value>(charges, values, slab_stride);
  });
}

void spread_rounded(const SortedCharges<double>& charges, float* values) {
  with_spline_order(charges.order,
                    [&](auto constant) { spread_rounded_of_order<decltype(constant)::value>(charges, values); });
}

template SortedCharges<float> sort_charges(Buffer<GridCharge>, std::array<int, 3>, int);
template SortedCharges<double> sort_charges(Buffer<GridCharge>, std::array<int, 3>, int);
template void spread_by_slabs(const SortedCharges<float>&, float*, std::size_t);
template void spread_by_slabs(const SortedCharges<double>&, double*, std::size_t);
template void spread_by_points(const SortedCharges<float>&, float*, std::size_t);
template void spread_by_points(const SortedCharges<double>&, double*, std::size_t);

}  // namespace espdiff::ESPDIFF_BACKEND
