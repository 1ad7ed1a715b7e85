// bulk_zero.cu: finds the grid points far from the solute, and subtracts their mean.
#include "cuda/potential/bulk_zero.h"

#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/potential/map_origin.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Sum and number of the selected values.
struct Total {
  double sum = 0, n = 0;
  ESPDIFF_HD Total& operator+=(const Total& other) {
    sum += other.sum;
    n += other.n;
    return *this;
  }
};

/// [point] 1 if every image of every atom is farther than the distance, otherwise 0.
Buffer<std::uint32_t> far_points(const Lattice& lattice, const std::vector<Vec3d>& solute, double distance_A) {
  Buffer<std::uint32_t> far(lattice.n_points(), 1U);
  double to_index[12];
  set_index_transform(lattice, {}, "the cell", to_index);
  double reach[3];  // in lattice steps, along each axis
  for (int axis = 0; axis < 3; ++axis) {
    const double* const row = to_index + std::ptrdiff_t{4} * axis;
    reach[axis] = distance_A * norm(Vec3d{row[0], row[1], row[2]});
  }
  std::vector<Vec3d> places;
  for (const Vec3d& p : solute) {
    Vec3d c;
    for (int axis = 0; axis < 3; ++axis) {
      const double* const row = to_index + std::ptrdiff_t{4} * axis;
      c[axis] = row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
    }
    places.push_back(c);
  }
  const Buffer<Vec3d> atoms = to_device(places);
  const Vec3d* const at = raw(atoms);
  std::uint32_t* const out = raw(far);
  const int nx = lattice.size[0], ny = lattice.size[1], nz = lattice.size[2];
  const Vec3d a = lattice.step[0], b = lattice.step[1], d = lattice.step[2];
  const double rx = reach[0], ry = reach[1], rz = reach[2], square = distance_A * distance_A;
  for_each_index(places.size(), [=] ESPDIFF_HD(std::size_t n) {
    const Vec3d c = at[n];
    for (int k = static_cast<int>(ceil(c.z - rz)); k <= static_cast<int>(floor(c.z + rz)); ++k) {
      for (int j = static_cast<int>(ceil(c.y - ry)); j <= static_cast<int>(floor(c.y + ry)); ++j) {
        for (int i = static_cast<int>(ceil(c.x - rx)); i <= static_cast<int>(floor(c.x + rx)); ++i) {
          const Vec3d to = (i - c.x) * a + (j - c.y) * b + (k - c.z) * d;
          if (dot(to, to) > square) continue;
          const int x = static_cast<int>(wrapped(i, nx)), y = static_cast<int>(wrapped(j, ny)),
                    z = static_cast<int>(wrapped(k, nz));
          atomic_minimum(
              out + (static_cast<std::size_t>(x) +
                     static_cast<std::size_t>(nx) *
                         (static_cast<std::size_t>(y) + static_cast<std::size_t>(ny) * static_cast<std::size_t>(z))),
              0U);
        }
      }
    }
  });
  return far;
}

}  // namespace

Buffer<float> bulk_weights(const Lattice& lattice, const std::vector<Vec3d>& solute, double distance_A) {
  const Buffer<std::uint32_t> far = far_points(lattice, solute, distance_A);
  const std::uint32_t* const counts = raw(far);
  const double n = sum_over<double>(far.size(), [=] ESPDIFF_HD(std::size_t i) { return counts[i] != 0 ? 1.0 : 0.0; });
  Buffer<float> weights(far.size());
  float* const out = raw(weights);
  for_each_index(far.size(),
                 [=] ESPDIFF_HD(std::size_t i) { out[i] = counts[i] != 0 ? static_cast<float>(1.0 / n) : 0.0F; });
  return weights;
}

std::shared_ptr<MapGrid> zero_in_bulk(const MapGrid& map, const std::vector<Vec3d>& solute, double distance_A,
                                      BulkZero* report) {
  if (!map.periodic) throw InputError("a zero in the bulk was asked for of a map that is not periodic");
  if (!(distance_A >= 0) || !std::isfinite(distance_A))
    throw InputError("a distance of " + formatted(distance_A) + " A from the solute; 10 is usual");
  for (const Vec3d& p : solute) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw InputError("the solute has a coordinate that is not finite");
  }
  const Buffer<std::uint32_t> far = far_points(map.lattice, solute, distance_A);
  const Buffer<float> values = lattice_values(map);
  const std::uint32_t* const counts = raw(far);
  const float* const value = raw(values);
  const Total total = sum_over<Total>(far.size(), [=] ESPDIFF_HD(std::size_t i) {
    return counts[i] != 0 ? Total{static_cast<double>(value[i]), 1} : Total{};
  });
  BulkZero found;
  found.fraction = total.n / static_cast<double>(far.size());
  found.mean_there = total.n > 0 ? total.sum / total.n : 0;
  if (report != nullptr) *report = found;
  auto result = std::make_shared<MapGrid>(map);
  if (total.n > 0) {
    result->zero = found.mean_there;
    if (map.origin != nullptr) {
      auto origin = std::make_shared<MapOrigin>(*map.origin);
      origin->solute = solute;
      origin->bulk_distance_A = distance_A;
      result->origin = std::move(origin);
    }
  }
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
