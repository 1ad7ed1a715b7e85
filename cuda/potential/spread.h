// spread.h: point charges spread over a periodic grid by B-splines, as a gather that adds in a fixed order.
#pragma once

#include <array>
#include <cstdint>

#include "cuda/surface/density/bspline.h"

namespace espdiff::ESPDIFF_BACKEND {

/// A charge in its cell: grid coordinates u, 0 <= u < size along each axis.
struct GridCharge {
  double u[3];
  double charge;
  std::uint32_t row;  ///< base_y + size_y * base_z of the grid points that it touches
  int base_x;
};

/// Charges sorted by row, then base_x, then position and charge: a unique order, whatever order they came in.
template <typename T>
struct SortedCharges {
  int order = 4;
  std::array<int, 3> size{};
  Buffer<std::uint32_t> row_first;  ///< [row + 1] first charge of each row
  Buffer<int> base_x;               ///< [charge]
  Buffer<T> weights;                ///< [charge][axis][stored weight]; those of z times the charge
};

/// @param charges with u and charge set; those of charge 0 are left out
template <typename T>
SortedCharges<T> sort_charges(Buffer<GridCharge> charges, std::array<int, 3> size, int order);

/// values(n) = sum_i q_i M(u_ix - n_x) M(u_iy - n_y) M(u_iz - n_z) on every grid point, slab after slab: each charge is
/// visited for each slab that it touches. Adds in the order of spread_by_points() and gives the same bits.
template <typename T>
void spread_by_slabs(const SortedCharges<T>& charges, T* values, std::size_t slab_stride);
/// The same, each grid point gathering from the charges that touch it.
template <typename T>
void spread_by_points(const SortedCharges<T>& charges, T* values, std::size_t slab_stride);

/// The sums in double precision, each rounded once; slabs follow each other.
void spread_rounded(const SortedCharges<double>& charges, float* values);

}  // namespace espdiff::ESPDIFF_BACKEND
