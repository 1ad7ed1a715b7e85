// difference_map.cpp: Gaussian means of vertex values, one plane of the lattice after the other.
#include "report/difference_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <sstream>
#include <string>

#include "base/error.h"

namespace espdiff {
namespace {

constexpr double kWidth_A = 1;

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// A vertex that has a value.
struct Source {
  Vec3d position;
  double area = 0;  // only ratios matter
  double value = 0;
};

std::vector<Source> collect_sources(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                                    const std::vector<float>& values) {
  if (values.size() != positions.size()) {
    throw InputError("the map's surface has " + std::to_string(positions.size()) + " vertices, but " +
                     std::to_string(values.size()) + " values were given; the numbers must be equal");
  }
  std::vector<double> area(positions.size(), 0.0);
  for (const Triangle& t : triangles) {
    const Vec3d normal = cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]);
    for (const std::uint32_t vertex : t) area[vertex] += norm(normal);
  }
  std::vector<Source> sources;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const bool counts = std::isfinite(values[i]) && area[i] > 0;
    if (counts) sources.push_back({positions[i], area[i], static_cast<double>(values[i])});
  }
  if (sources.empty()) {
    throw InputError("no vertex of the surface has a value to make a map of; does the potential map cover it?");
  }
  return sources;
}

/// The least lattice, on multiples of the spacing, that has the reach of all sources within it.
Lattice lattice_around(const std::vector<Source>& sources, double spacing) {
  Lattice lattice;
  double n_points = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(sources.begin(), sources.end(), [axis](const auto& a, const auto& b) {
      return a.position[axis] < b.position[axis];
    });
    const double first = std::floor((low->position[axis] - kMapReach_A) / spacing);
    const double last = std::ceil((high->position[axis] + kMapReach_A) / spacing);
    n_points *= last - first + 1;
    if (!(n_points <= std::numeric_limits<int>::max())) {
      throw MemoryError("a map with spacing " + shown(spacing) +
                        " A around this surface has more than 2^31 - 1 points; take a larger spacing");
    }
    lattice.size[static_cast<std::size_t>(axis)] = static_cast<int>(last - first) + 1;
    lattice.origin[axis] = first * spacing;
    lattice.step[static_cast<std::size_t>(axis)][axis] = spacing;
  }
  return lattice;
}

/// Lattice indices along one axis that are in reach of a source, and the weights there.
struct Span {
  std::ptrdiff_t begin = 0;
  std::vector<double> weight, square;  // exp(-d^2 / 2 s^2) and d^2

  void set(double position, double origin, double spacing) {
    begin = static_cast<std::ptrdiff_t>(std::ceil((position - kMapReach_A - origin) / spacing));
    const auto end = static_cast<std::ptrdiff_t>(std::floor((position + kMapReach_A - origin) / spacing)) + 1;
    weight.resize(static_cast<std::size_t>(end - begin));
    square.resize(weight.size());
    for (std::size_t i = 0; i < weight.size(); ++i) {
      const double d = origin + spacing * static_cast<double>(begin + static_cast<std::ptrdiff_t>(i)) - position;
      square[i] = d * d;
      weight[i] = std::exp(-square[i] / (2 * kWidth_A * kWidth_A));
    }
  }
};

/// Sums over the sources at the points of one plane.
class Plane {
 public:
  explicit Plane(const Lattice& lattice)
      : lattice_(lattice),
        n_(static_cast<std::size_t>(lattice.size[0]) * static_cast<std::size_t>(lattice.size[1])),
        weights_(n_),
        values_(n_),
        nearest_(n_) {}

  void clear() {
    std::fill(weights_.begin(), weights_.end(), 0.0);
    std::fill(values_.begin(), values_.end(), 0.0);
    std::fill(nearest_.begin(), nearest_.end(), kFar);
  }

  void add(const Source& source, double z) {
    constexpr double kReachSquare = kMapReach_A * kMapReach_A;
    x_.set(source.position.x, lattice_.origin.x, lattice_.step[0].x);
    y_.set(source.position.y, lattice_.origin.y, lattice_.step[1].y);
    const double dz = z - source.position.z;
    const double scale = source.area * std::exp(-dz * dz / (2 * kWidth_A * kWidth_A));
    for (std::size_t j = 0; j < y_.weight.size(); ++j) {
      const double square_yz = y_.square[j] + dz * dz;
      if (square_yz > kReachSquare) continue;
      const std::size_t row =
          static_cast<std::size_t>(x_.begin + lattice_.size[0] * (y_.begin + static_cast<std::ptrdiff_t>(j)));
      const double scale_yz = scale * y_.weight[j];
      for (std::size_t i = 0; i < x_.weight.size(); ++i) {
        const double square = x_.square[i] + square_yz;
        const double weight = square < kReachSquare ? scale_yz * x_.weight[i] : 0.0;
        weights_[row + i] += weight;
        values_[row + i] += weight * source.value;
        nearest_[row + i] = std::min(nearest_[row + i], square);
      }
    }
  }

  void write(float* out) const {
    for (std::size_t p = 0; p < n_; ++p) {
      if (weights_[p] > 0) out[p] = static_cast<float>(fade(std::sqrt(nearest_[p])) * values_[p] / weights_[p]);
    }
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::max();

  static double fade(double distance) {
    const double t = std::clamp((kMapReach_A - distance) / (kMapReach_A - kMapBand_A), 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }

  const Lattice& lattice_;
  std::size_t n_;
  std::vector<double> weights_, values_, nearest_;
  Span x_, y_;
};

void fill_map(Grid& map, std::vector<Source> sources) {
  const Lattice& lattice = map.lattice;
  map.values.assign(lattice.n_points(), 0.0F);
  std::stable_sort(sources.begin(), sources.end(),
                   [](const Source& a, const Source& b) { return a.position.z < b.position.z; });
  Plane plane(lattice);
  auto first = sources.begin();
  for (int k = 0; k < lattice.size[2]; ++k) {
    const double z = lattice.origin.z + k * lattice.step[2].z;
    while (first != sources.end() && first->position.z < z - kMapReach_A) ++first;
    plane.clear();
    for (auto source = first; source != sources.end() && source->position.z <= z + kMapReach_A; ++source) {
      plane.add(*source, z);
    }
    plane.write(map.values.data() + static_cast<std::size_t>(k) * static_cast<std::size_t>(lattice.size[0]) *
                                        static_cast<std::size_t>(lattice.size[1]));
  }
}

}  // namespace

Grid surface_quantity_map(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                          const std::vector<float>& values, double spacing_A) {
  if (!(spacing_A >= kLeastMapSpacing_A && spacing_A <= kMostMapSpacing_A)) {
    throw InputError("map spacing " + shown(spacing_A) + " A; " + shown(kLeastMapSpacing_A) + " to " +
                     shown(kMostMapSpacing_A) + " A was expected");
  }
  std::vector<Source> sources = collect_sources(positions, triangles, values);
  Grid map;
  map.name = "surface map";
  map.lattice = lattice_around(sources, spacing_A);
  try {
    fill_map(map, std::move(sources));
  } catch (const std::bad_alloc&) {
    throw MemoryError("a map of " + std::to_string(map.lattice.n_points()) +
                      " points does not fit into memory; take a larger spacing");
  }
  return map;
}

}  // namespace espdiff
