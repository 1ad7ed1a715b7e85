// sample.h: interpolation on lattices: fields for deform(), potential maps for the metrics.
#pragma once

#include <string>
#include <vector>

#include "cuda/device/quad.h"
#include "cuda/surface/density/charge_sums.h"
#include "cuda/surface/density/grid.h"
#include "cuda/surface/mesh/mesh.h"
#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

struct MapOrigin;

/// A potential map with the transform into it from the common frame.
struct MapGrid : DeviceGrid {
  Lattice lattice;  ///< the map's own frame
  PotentialUnit unit = PotentialUnit::kUnknown;
  Buffer<float> values;      ///< [point] x fastest
  double to_index[12] = {};  ///< row-major 3 x 4: common frame -> lattice indices
  bool periodic = false;     ///< repeats after `size` points
  /// 0: the values are the map's at the points, interpolated linearly. Otherwise they are coefficients of centred
  /// B-splines of this order; periodic maps only.
  int spline_order = 0;
  /// Point charges whose potential is added to what the values say: the direct part of Ewald's sum where the map is
  /// periodic; otherwise isolated charges, whose map has no points (size 0) and is nothing but their sum.
  std::shared_ptr<const ChargeSums> charge_sums;
  double zero = 0;                          ///< subtracted from every sample, in the map's unit
  std::shared_ptr<const MapOrigin> origin;  ///< of a map that was computed here; null for others
};

/// The transform from the common frame to lattice indices, row-major 3 x 4.
/// @throws InputError if the axes do not span space
void set_index_transform(const Lattice& lattice, const RigidTransform& to_map, const std::string& name,
                         double (&to_index)[12]);

/// @throws InputError if the map's axes do not span space
std::shared_ptr<MapGrid> make_map(const Grid& map, const RigidTransform& to_map);

/// [vertex] samples, by linear interpolation or splines as the map says; NaN outside a map that is not periodic.
std::shared_ptr<Scalars> sample(const MapGrid& map, const SurfaceMesh& mesh);
/// [vertex] gradients in the common frame; see Engine::sample_gradient().
Buffer<Vec4f> sample_gradient(const MapGrid& map, const SurfaceMesh& mesh);
/// Samples at the points of a lattice in the common frame.
std::shared_ptr<MapGrid> resample(const MapGrid& map, const Lattice& lattice);
/// Places in lattice coordinates with weights: what a reading of a map consists of.
struct WeightedPlaces {
  std::vector<Vec3d> place;
  std::vector<double> weight;
};
WeightedPlaces weighted_places(const MapGrid& map, const PotentialReading& reading);
/// Values at some points of a lattice, ascending, each point once.
struct SparseValues {
  std::vector<std::size_t> point;
  std::vector<float> value;
};
/// The transpose of linear interpolation: sum_v weight_v sample(v) = sum_p value_p map(p), without charge sums and
/// zero.
/// @throws InputError for a place outside the map
SparseValues spread_linearly(const MapGrid& map, const WeightedPlaces& places);
/// [place] what the values alone say at places in lattice coordinates.
std::vector<float> values_at(const MapGrid& map, const std::vector<Vec3d>& places);
/// What the values alone say at the map's own points, without charge sums and zero.
Buffer<float> lattice_values(const MapGrid& map);
/// The map's samples at its own points.
std::vector<float> point_values(const MapGrid& map);

struct CellPosition {
  int base[3];    ///< lattice point below
  float part[3];  ///< 0 to 1 within the cell
};

/// The position of p in the lattice, clamped so that `margin` points exist below the base and `margin` + 1 above it.
ESPDIFF_INLINE CellPosition locate(const CubicLattice& lattice, Vec3f p, int margin) {
  CellPosition at;
  const float inverse_spacing = 1.0F / lattice.spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const float lowest = static_cast<float>(margin), highest = static_cast<float>(lattice.size[axis] - 1 - margin);
    const float c = smaller(larger((p[axis] - lattice.origin[axis]) * inverse_spacing, lowest), highest);
    int base = static_cast<int>(c);
    if (base > lattice.size[axis] - 2 - margin) base = lattice.size[axis] - 2 - margin;
    at.base[axis] = base;
    at.part[axis] = c - static_cast<float>(base);
  }
  return at;
}

ESPDIFF_INLINE Quad mix(const Quad& a, const Quad& b, float t) { return a + t * (b - a); }

/// Linear interpolation in the cell whose lowest corner is `v`, in a lattice of rows of nx and planes of nxy points.
ESPDIFF_INLINE Quad mix_cell(const Vec4f* v, std::size_t nx, std::size_t nxy, float x, float y, float z) {
  const auto along_x = [&](std::size_t row)
                           ESPDIFF_INLINE_LAMBDA { return mix(quad_of(v[row]), quad_of(v[row + 1]), x); };
  const Quad near_low = along_x(0), near_high = along_x(nx), far_low = along_x(nxy), far_high = along_x(nxy + nx);
  return mix(mix(near_low, near_high, y), mix(far_low, far_high, y), z);
}

/// Trilinear interpolation; clamped at the border.
ESPDIFF_INLINE Vec4f sample_trilinear(const CubicLattice& lattice, const Vec4f* values, Vec3f p) {
  const CellPosition at = locate(lattice, p, 0);
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]),
                    nxy = nx * static_cast<std::size_t>(lattice.size[1]);
  const Vec4f* const v = values + lattice.index(at.base[0], at.base[1], at.base[2]);
  return vec4_of(mix_cell(v, nx, nxy, at.part[0], at.part[1], at.part[2]));
}

/// Catmull-Rom weights of the four points around t in [0, 1].
ESPDIFF_INLINE void catmull_rom(float t, float (&w)[4]) {
  const float t2 = t * t, t3 = t2 * t;
  w[0] = 0.5F * (-t3 + 2.0F * t2 - t);
  w[1] = 0.5F * (3.0F * t3 - 5.0F * t2 + 2.0F);
  w[2] = 0.5F * (-3.0F * t3 + 4.0F * t2 + t);
  w[3] = 0.5F * (t3 - t2);
}

/// Tricubic (Catmull-Rom) interpolation; clamped one layer inside the border.
ESPDIFF_INLINE Vec4f sample_tricubic(const CubicLattice& lattice, const Vec4f* values, Vec3f p) {
  const CellPosition at = locate(lattice, p, 1);
  float wx[4], wy[4], wz[4];
  catmull_rom(at.part[0], wx);
  catmull_rom(at.part[1], wy);
  catmull_rom(at.part[2], wz);
  Vec4f sum{};
  for (int k = 0; k < 4; ++k) {
    Vec4f layer{};
    for (int j = 0; j < 4; ++j) {
      const Vec4f* const row = values + lattice.index(at.base[0] - 1, at.base[1] - 1 + j, at.base[2] - 1 + k);
      layer = layer + wy[j] * (wx[0] * row[0] + wx[1] * row[1] + wx[2] * row[2] + wx[3] * row[3]);
    }
    sum = sum + wz[k] * layer;
  }
  return sum;
}

}  // namespace espdiff::ESPDIFF_BACKEND
