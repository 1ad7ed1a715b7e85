// grid_kernels.h: runs a kernel over the inner points of a grid: row by row on the CPU, point by point on a GPU.
//
// A kernel is a struct of pointers with at(point, colour), which writes the values of that point only. A coloured
// kernel (kColoured) is called for the points of one colour, and reads neighbours of the other.
#pragma once

#include <algorithm>

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Numbers of points; x fastest.
struct GridSize {
  int nx = 0, ny = 0, nz = 0;

  ESPDIFF_INLINE std::size_t row() const { return static_cast<std::size_t>(nx); }
  ESPDIFF_INLINE std::size_t plane() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  ESPDIFF_INLINE std::size_t points() const { return plane() * static_cast<std::size_t>(nz); }
  ESPDIFF_INLINE std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) + row() * static_cast<std::size_t>(j) + plane() * static_cast<std::size_t>(k);
  }
};

/// A coloured kernel takes every other point of a row.
template <typename Kernel>
constexpr int stride_of() {
  return Kernel::kColoured ? 2 : 1;
}

#if !defined(__CUDACC__)

/// Smaller grids run on one thread: starting the others would take longer.
constexpr std::size_t kSerialPoints = 8192;

/// The rows of planes [k0, k1), without the border.
template <typename Kernel>
ESPDIFF_INLINE void run_rows(const Kernel& given, const GridSize& size, int k0, int k1) {
  const Kernel kernel = given;
  const GridSize n = size;
  constexpr int kStride = stride_of<Kernel>();
  for (int k = k0; k < k1; ++k) {
    for (int j = 1; j < n.ny - 1; ++j) {
      const std::size_t row = n.index(0, j, k);
      const int parity = j + k;
      const int first = kStride == 2 && ((1 + parity) & 1) != kernel.colour ? 2 : 1;
#pragma GCC ivdep
      for (int i = first; i < n.nx - 1; i += kStride) kernel.at(row + static_cast<std::size_t>(i), (i + parity) & 1);
    }
  }
}

/// Compiles a kernel's rows for several instruction sets, which is not possible for a template.
#define ESPDIFF_GRID_KERNEL(Kernel)                                                                       \
  ESPDIFF_MULTIVERSION void run_kernel_rows(const Kernel& kernel, const GridSize& size, int k0, int k1) { \
    run_rows(kernel, size, k0, k1);                                                                       \
  }

/// Calls kernel.at() for every inner point.
template <typename Kernel>
void run_on_grid(const GridSize& size, const Kernel& kernel) {
  if (size.nx < 3 || size.ny < 3 || size.nz < 3) return;
  if (size.points() < kSerialPoints) {
    run_kernel_rows(kernel, size, 1, size.nz - 1);
    return;
  }
  for_each_index(static_cast<std::size_t>(size.nz - 2), [=](std::size_t k) {
    run_kernel_rows(kernel, size, static_cast<int>(k) + 1, static_cast<int>(k) + 2);
  });
}

#else

#define ESPDIFF_GRID_KERNEL(Kernel)

template <typename Kernel>
void run_on_grid(const GridSize& size, const Kernel& kernel) {
  if (size.nx < 3 || size.ny < 3 || size.nz < 3) return;
  const std::size_t rows = static_cast<std::size_t>(size.ny - 2), planes = static_cast<std::size_t>(size.nz - 2);
  constexpr int kStride = stride_of<Kernel>();
  const std::size_t in_row = static_cast<std::size_t>((size.nx - 2 + kStride - 1) / kStride);
  for_each_index(in_row * rows * planes, [=] ESPDIFF_HD(std::size_t t) {
    const int j = static_cast<int>(t / in_row % rows) + 1, k = static_cast<int>(t / (in_row * rows)) + 1;
    int i = static_cast<int>(t % in_row) * kStride + 1;
    if (kStride == 2 && ((i + j + k) & 1) != kernel.colour) ++i;
    if (i < size.nx - 1) kernel.at(size.index(i, j, k), (i + j + k) & 1);
  });
}

#endif

/// Several independent partial sums, so that additions do not wait for each other.
struct LaneSums {
  static constexpr int kLanes = 8;
  double sum[kLanes] = {};

  ESPDIFF_INLINE void operator+=(const LaneSums& other) {
    for (int lane = 0; lane < kLanes; ++lane) sum[lane] += other.sum[lane];
  }
  ESPDIFF_INLINE double total() const {
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
  }
};

}  // namespace espdiff::ESPDIFF_BACKEND
