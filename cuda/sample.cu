// sample.cu: potential maps on the device, and their samples at a mesh's vertices.
#include "sample.h"

#include <cmath>
#include <limits>

#include "base/error.h"

namespace espdiff::ESPDIFF_BACKEND {

std::shared_ptr<MapGrid> make_map(const Grid& map, const RigidTransform& to_map) {
  auto result = std::make_shared<MapGrid>();
  result->lattice = map.lattice;
  result->unit = map.unit;
  result->values = to_device(map.values);
  const auto& step = map.lattice.step;
  const double volume = dot(step[0], cross(step[1], step[2]));
  if (!(std::fabs(volume) > 0) || !std::isfinite(volume))
    throw InputError(map.name + ": the map's axes do not span space");
  // Rows of the inverse of the matrix whose columns are the steps.
  const Vec3d inverse[3] = {(1.0 / volume) * cross(step[1], step[2]), (1.0 / volume) * cross(step[2], step[0]),
                            (1.0 / volume) * cross(step[0], step[1])};
  const double* const r = to_map.rotation;
  const Vec3d shift = to_map.translation - map.lattice.origin;
  for (int row = 0; row < 3; ++row) {
    const Vec3d& m = inverse[row];
    for (int column = 0; column < 3; ++column) {
      result->to_index[4 * row + column] = m.x * r[column] + m.y * r[3 + column] + m.z * r[6 + column];
    }
    result->to_index[4 * row + 3] = dot(m, shift);
  }
  return result;
}

namespace {

/// Row-major 3 x 4, passed to the kernel by value.
struct Affine {
  double m[12];
};

}  // namespace

std::shared_ptr<Scalars> sample(const MapGrid& map, const SurfaceMesh& mesh) {
  Affine to_index;
  for (int i = 0; i < 12; ++i) to_index.m[i] = map.to_index[i];
  auto result = std::make_shared<Scalars>();
  result->values.resize(mesh.n_vertices());
  const float* const values = raw(map.values);
  const Vec4f* const x = raw(mesh.positions);
  float* const out = raw(result->values);
  const long nx = map.lattice.size[0], ny = map.lattice.size[1], nz = map.lattice.size[2];
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  // A vertex on the border of a map counts as inside despite rounding.
  constexpr double kSlack = 1e-6;
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    const long size[3] = {nx, ny, nz};
    long base[3];
    double part[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double* const row = to_index.m + 4 * axis;
      double c = row[0] * static_cast<double>(x[v].x) + row[1] * static_cast<double>(x[v].y) +
                 row[2] * static_cast<double>(x[v].z) + row[3];
      const double last = static_cast<double>(size[axis] - 1);
      if (!(c >= -kSlack && c <= last + kSlack) || size[axis] < 2) {
        out[v] = kNan;
        return;
      }
      c = c < 0 ? 0 : c > last ? last : c;
      base[axis] = static_cast<long>(c);
      if (base[axis] > size[axis] - 2) base[axis] = size[axis] - 2;
      part[axis] = c - static_cast<double>(base[axis]);
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
      const double weight =
          (dx != 0 ? part[0] : 1 - part[0]) * (dy != 0 ? part[1] : 1 - part[1]) * (dz != 0 ? part[2] : 1 - part[2]);
      sum += weight * static_cast<double>(values[base[0] + dx + nx * (base[1] + dy + ny * (base[2] + dz))]);
    }
    out[v] = static_cast<float>(sum);
  });
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
