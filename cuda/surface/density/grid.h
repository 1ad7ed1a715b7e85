// grid.h: a cubic lattice with scalars and fields on it, as kernels see them.
#pragma once

#include <array>

#include "base/handles.h"
#include "base/types.h"
#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// A cubic lattice, x fastest: point (i, j, k) lies at origin + spacing * (i, j, k) and has index i + size[0]*(j +
/// size[1]*k).
struct CubicLattice {
  int size[3];
  Vec3f origin;   ///< Angstrom, common frame
  float spacing;  ///< Angstrom

  ESPDIFF_INLINE std::size_t n_points() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
  ESPDIFF_INLINE std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k));
  }
  ESPDIFF_INLINE float coordinate(int axis, int i) const { return origin[axis] + spacing * static_cast<float>(i); }
  ESPDIFF_INLINE Vec3f point(int i, int j, int k) const {
    return {coordinate(0, i), coordinate(1, j), coordinate(2, k)};
  }
};

/// The lattice row (j, k) with a given number.
struct LatticeRow {
  int j, k;
};
ESPDIFF_INLINE LatticeRow lattice_row(const CubicLattice& lattice, std::size_t row) {
  return {static_cast<int>(row % static_cast<std::size_t>(lattice.size[1])),
          static_cast<int>(row / static_cast<std::size_t>(lattice.size[1]))};
}

/// The density on a cubic lattice.
struct DensityGrid : DeviceGrid {
  CubicLattice lattice{};
  Buffer<float> values;  ///< [point]
};

/// The field that deform() follows: the value (positive inside, zero on the surface) in w, its gradient in x, y, z.
struct SurfaceField : DeviceField {
  CubicLattice lattice{};
  Buffer<Vec4f> values;  ///< [point] gradient in 1/Angstrom (density) or 1 (distance)
};

Lattice host_lattice(const CubicLattice& lattice);

}  // namespace espdiff::ESPDIFF_BACKEND
