// sample.cu: potential maps on the device, sampled at a mesh's vertices or on another lattice.
#include "cuda/surface/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "cuda/surface/density/bspline.h"

namespace espdiff::ESPDIFF_BACKEND {

void set_index_transform(const Lattice& lattice, const RigidTransform& to_map, const std::string& name,
                         double (&to_index)[12]) {
  const auto& step = lattice.step;
  const double volume = dot(step[0], cross(step[1], step[2]));
  if (!(std::fabs(volume) > 0) || !std::isfinite(volume)) throw InputError(name + ": the map's axes do not span space");
  // Rows of the inverse of the matrix with the steps as columns.
  const Vec3d inverse[3] = {(1.0 / volume) * cross(step[1], step[2]), (1.0 / volume) * cross(step[2], step[0]),
                            (1.0 / volume) * cross(step[0], step[1])};
  const double* const r = to_map.rotation;
  const Vec3d shift = to_map.translation - lattice.origin;
  for (int row = 0; row < 3; ++row) {
    const Vec3d& m = inverse[row];
    for (int column = 0; column < 3; ++column) {
      to_index[4 * row + column] = m.x * r[column] + m.y * r[3 + column] + m.z * r[6 + column];
    }
    to_index[4 * row + 3] = dot(m, shift);
  }
}

std::shared_ptr<MapGrid> make_map(const Grid& map, const RigidTransform& to_map) {
  auto result = std::make_shared<MapGrid>();
  result->lattice = map.lattice;
  result->unit = map.unit;
  result->values = to_device(map.values);
  result->periodic = map.periodic;
  set_index_transform(map.lattice, to_map, map.name, result->to_index);
  return result;
}

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Kernel view of a map, passed by value.
struct MapView {
  const float* values;
  long size[3];
  bool periodic;
  int spline_order;
  double zero;
  ChargeSumsView sums;
  double to_index[12];

  ESPDIFF_INLINE double coordinate(int axis, Vec3d p) const {
    const double* const row = to_index + std::ptrdiff_t{4} * axis;
    return row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
  }
};

MapView view_of(const MapGrid& map) {
  MapView view{raw(map.values), {}, map.periodic, map.spline_order, map.zero, {}, {}};
  if (map.charge_sums != nullptr) view.sums = map.charge_sums->view();
  for (std::size_t axis = 0; axis < 3; ++axis) view.size[axis] = map.lattice.size[axis];
  for (int i = 0; i < 12; ++i) view.to_index[i] = map.to_index[i];
  return view;
}

/// The two points around a coordinate on one axis, and the fraction between them.
struct Neighbours {
  long low, high;
  double part;
};

/// Returns false outside.
ESPDIFF_INLINE bool find_neighbours(const MapView& map, int axis, double c, Neighbours& found) {
  const long size = map.size[axis];
  if (map.periodic) {
    if (!(c - c == 0)) return false;
    const double inside = wrapped(c, static_cast<int>(size));
    found.low = static_cast<long>(inside);
    found.high = found.low + 1 < size ? found.low + 1 : 0;
    found.part = inside - static_cast<double>(found.low);
    return true;
  }
  // A vertex on a map's border is inside despite rounding.
  constexpr double kSlack = 1e-6;
  const double last = static_cast<double>(size - 1);
  if (!(c >= -kSlack && c <= last + kSlack) || size < 2) return false;
  c = c < 0 ? 0 : c > last ? last : c;
  found.low = static_cast<long>(c);
  if (found.low > size - 2) found.low = size - 2;
  found.high = found.low + 1;
  found.part = c - static_cast<double>(found.low);
  return true;
}

ESPDIFF_INLINE float sample_linear(const MapView& map, const double (&c)[3]) {
  Neighbours at[3];
  for (int axis = 0; axis < 3; ++axis) {
    if (!find_neighbours(map, axis, c[axis], at[axis])) return kNan;
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const bool up[3] = {(corner & 1) != 0, (corner >> 1 & 1) != 0, corner >> 2 != 0};
    double weight = up[0] ? at[0].part : 1 - at[0].part;
    weight *= up[1] ? at[1].part : 1 - at[1].part;
    weight *= up[2] ? at[2].part : 1 - at[2].part;
    const long x = up[0] ? at[0].high : at[0].low, y = up[1] ? at[1].high : at[1].low,
               z = up[2] ? at[2].high : at[2].low;
    sum += weight * static_cast<double>(map.values[x + map.size[0] * (y + map.size[1] * z)]);
  }
  return static_cast<float>(sum);
}

template <int Order>
ESPDIFF_INLINE float sample_spline(const MapView& map, const double (&c)[3]) {
  int base[3];
  double weight[3][kStoredWeights<Order>];
  for (int axis = 0; axis < 3; ++axis) {
    if (!(c[axis] - c[axis] == 0)) return kNan;
    const int size = static_cast<int>(map.size[axis]);
    const SplinePlace place = spline_place(wrapped(c[axis], size), Order, size);
    base[axis] = place.base;
    spline_weights<Order>(place.part, weight[axis]);
  }
  double sum = 0;
  for (int k = 0; k < Order; ++k) {
    const long z = base[2] + k < map.size[2] ? base[2] + k : base[2] + k - map.size[2];
    for (int j = 0; j < Order; ++j) {
      const long y = base[1] + j < map.size[1] ? base[1] + j : base[1] + j - map.size[1];
      const float* const row = map.values + map.size[0] * (y + map.size[1] * z);
      double row_sum = 0;
      for (int i = 0; i < Order; ++i) {
        const long x = base[0] + i < map.size[0] ? base[0] + i : base[0] + i - map.size[0];
        row_sum += weight[0][i] * static_cast<double>(row[x]);
      }
      sum += weight[2][k] * weight[1][j] * row_sum;
    }
  }
  return static_cast<float>(sum);
}

ESPDIFF_INLINE float sample_at(const MapView& map, const double (&c)[3]) {
  switch (map.spline_order) {
    case 4: return sample_spline<4>(map, c);
    case 5: return sample_spline<5>(map, c);
    case 6: return sample_spline<6>(map, c);
    case 7: return sample_spline<7>(map, c);
    case 8: return sample_spline<8>(map, c);
    default: return sample_linear(map, c);
  }
}

/// Values, charge sums and zero together, at lattice coordinates; of isolated charges these are Angstrom.
ESPDIFF_INLINE float potential_at(const MapView& map, const double (&c)[3]) {
  const bool charges = map.sums.charges != nullptr;
  if (charges && map.sums.first == nullptr) {
    return static_cast<float>(map.sums.isolated({c[0], c[1], c[2]}) - map.zero);
  }
  const float smooth = sample_at(map, c);
  if (!charges) return static_cast<float>(static_cast<double>(smooth) - map.zero);
  if (!(smooth - smooth == 0.0F)) return smooth;
  double parts[3];
  for (int axis = 0; axis < 3; ++axis) parts[axis] = c[axis] / static_cast<double>(map.size[axis]);
  return static_cast<float>(static_cast<double>(smooth) + map.sums.direct(parts) - map.zero);
}

/// The slope along one lattice axis, per lattice step. Between points of a linear map: central differences over two
/// steps, which are the interpolated central differences at the points. Otherwise the map is smooth, and the difference
/// of fourth order over a tenth of an Angstrom.
ESPDIFF_INLINE double slope_along(const MapView& map, const double (&c)[3], int axis, double small_step) {
  const bool linear = map.spline_order == 0 && map.sums.charges == nullptr;
  const double step = linear ? 1 : small_step, shifts[4] = {step, -step, 2 * step, -2 * step};
  double at[4] = {};
  // A loop, so that the potential's long code is in the kernel once; six calls made 50 000 instructions.
  for (int i = 0; i < (linear ? 2 : 4); ++i) {
    double moved[3] = {c[0], c[1], c[2]};
    moved[axis] += shifts[i];
    at[i] = static_cast<double>(potential_at(map, moved));
  }
  if (linear) return 0.5 * (at[0] - at[1]);
  return (8 * (at[0] - at[1]) - (at[2] - at[3])) / (12 * small_step);
}

constexpr double kSmoothStep_A = 0.1;

}  // namespace

std::shared_ptr<Scalars> sample(const MapGrid& map, const SurfaceMesh& mesh) {
  auto result = std::make_shared<Scalars>();
  result->values.resize(mesh.n_vertices());
  const MapView view = view_of(map);
  const Vec4f* const x = raw(mesh.positions);
  float* const out = raw(result->values);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec3d p = static_cast<Vec3d>(x[v].xyz());
    const double c[3] = {view.coordinate(0, p), view.coordinate(1, p), view.coordinate(2, p)};
    out[v] = potential_at(view, c);
  });
  return result;
}

Buffer<Vec4f> sample_gradient(const MapGrid& map, const SurfaceMesh& mesh) {
  Buffer<Vec4f> gradients(mesh.n_vertices());
  const MapView view = view_of(map);
  Vec3d small_step;  // in lattice coordinates, which are Angstrom where a map has no points
  for (int axis = 0; axis < 3; ++axis) {
    const double* const row = map.to_index + std::ptrdiff_t{4} * axis;
    small_step[axis] = kSmoothStep_A * std::sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
  }
  const Vec4f* const x = raw(mesh.positions);
  Vec4f* const out = raw(gradients);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec3d p = static_cast<Vec3d>(x[v].xyz());
    const double c[3] = {view.coordinate(0, p), view.coordinate(1, p), view.coordinate(2, p)};
    Vec3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const double* const row = view.to_index + std::ptrdiff_t{4} * axis;
      gradient += slope_along(view, c, axis, small_step[axis]) * Vec3d{row[0], row[1], row[2]};
    }
    out[v] = make_vec4(static_cast<Vec3f>(gradient), 0.0F);
  });
  return gradients;
}

std::shared_ptr<MapGrid> resample(const MapGrid& map, const Lattice& lattice) {
  for (const int n : lattice.size) {
    if (n < 1) throw InputError("a lattice of " + std::to_string(n) + " points along an axis needs at least 1");
  }
  double n_points = 1;
  for (const int n : lattice.size) n_points *= n;
  require_grid(n_points, sizeof(float), "sampling a map");
  auto result = std::make_shared<MapGrid>();
  result->lattice = lattice;
  result->unit = map.unit;
  set_index_transform(lattice, {}, "the lattice to sample on", result->to_index);
  result->values.resize(lattice.n_points());
  const MapView view = view_of(map);
  float* const out = raw(result->values);
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]), ny = static_cast<std::size_t>(lattice.size[1]);
  const Vec3d origin = lattice.origin, a = lattice.step[0], b = lattice.step[1], d = lattice.step[2];
  for_each_index(lattice.n_points(), [=] ESPDIFF_HD(std::size_t i) {
    const std::size_t z = i / (nx * ny);
    const Vec3d p =
        origin + static_cast<double>(i % nx) * a + static_cast<double>(i / nx % ny) * b + static_cast<double>(z) * d;
    const double c[3] = {view.coordinate(0, p), view.coordinate(1, p), view.coordinate(2, p)};
    out[i] = potential_at(view, c);
  });
  return result;
}

WeightedPlaces weighted_places(const MapGrid& map, const PotentialReading& reading) {
  if (reading.weights.size() != reading.points.size()) throw InputError("a reading needs one weight for each point");
  const MapView view = view_of(map);
  WeightedPlaces places;
  places.place.reserve(reading.points.size());
  for (const Vec3f& point : reading.points) {
    const Vec3d p = static_cast<Vec3d>(point);
    places.place.push_back({view.coordinate(0, p), view.coordinate(1, p), view.coordinate(2, p)});
  }
  places.weight = reading.weights;
  return places;
}

SparseValues spread_linearly(const MapGrid& map, const WeightedPlaces& places) {
  /// What one place gives a point, and in which order.
  struct Part {
    std::size_t point, order;
    double weight;
  };
  const MapView view = view_of(map);
  std::vector<Part> parts;
  constexpr unsigned kCorners = 8;
  parts.reserve(kCorners * places.place.size());
  for (std::size_t v = 0; v < places.place.size(); ++v) {
    Neighbours at[3];
    for (int axis = 0; axis < 3; ++axis) {
      if (!find_neighbours(view, axis, places.place[v][axis], at[axis]))
        throw InputError("a reading has weight outside the potential map");
    }
    for (unsigned corner = 0; corner < kCorners; ++corner) {
      double weight = places.weight[v];
      long index = 0;
      for (int axis = 2; axis >= 0; --axis) {
        const bool up = (corner >> static_cast<unsigned>(axis) & 1U) != 0;
        weight *= up ? at[axis].part : 1 - at[axis].part;
        index = index * view.size[axis] + (up ? at[axis].high : at[axis].low);
      }
      parts.push_back({static_cast<std::size_t>(index), parts.size(), weight});
    }
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.point != b.point ? a.point < b.point : a.order < b.order; });
  SparseValues values;
  for (std::size_t i = 0; i < parts.size();) {
    const std::size_t point = parts[i].point;
    double sum = 0;
    for (; i < parts.size() && parts[i].point == point; ++i) sum += parts[i].weight;
    values.point.push_back(point);
    values.value.push_back(static_cast<float>(sum));
  }
  return values;
}

std::vector<float> values_at(const MapGrid& map, const std::vector<Vec3d>& places) {
  const MapView view = view_of(map);
  const Buffer<Vec3d> sent = to_device(places);
  Buffer<float> values(places.size());
  const Vec3d* const at = raw(sent);
  float* const out = raw(values);
  for_each_index(places.size(), [=] ESPDIFF_HD(std::size_t i) {
    const double c[3] = {at[i].x, at[i].y, at[i].z};
    out[i] = sample_at(view, c);
  });
  return to_host(values);
}

namespace {

template <typename SampleAt>
Buffer<float> at_own_points(const MapGrid& map, SampleAt sample_there) {
  Buffer<float> values(map.lattice.n_points());
  float* const out = raw(values);
  const std::size_t nx = static_cast<std::size_t>(map.lattice.size[0]),
                    ny = static_cast<std::size_t>(map.lattice.size[1]);
  for_each_index(values.size(), [=] ESPDIFF_HD(std::size_t i) {
    const std::size_t z = i / (nx * ny);
    const double c[3] = {static_cast<double>(i % nx), static_cast<double>(i / nx % ny), static_cast<double>(z)};
    out[i] = sample_there(c);
  });
  return values;
}

}  // namespace

Buffer<float> lattice_values(const MapGrid& map) {
  if (map.spline_order == 0) return map.values;
  const MapView view = view_of(map);
  return at_own_points(map, [=] ESPDIFF_HD(const double(&c)[3]) { return sample_at(view, c); });
}

std::vector<float> point_values(const MapGrid& map) {
  if (map.charge_sums == nullptr && map.zero == 0)
    return to_host(map.spline_order == 0 ? map.values : lattice_values(map));
  const MapView view = view_of(map);
  return to_host(at_own_points(map, [=] ESPDIFF_HD(const double(&c)[3]) { return potential_at(view, c); }));
}

}  // namespace espdiff::ESPDIFF_BACKEND
