// planted_columns.h: time series of known correlation and effect on a real mesh.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/counter_random.h"
#include "base/types.h"
#include "statistics/surface/mesh_graph.h"

namespace espdiff_test {

/// Standard normal numbers by counters (Box and Muller).
class Normal {
 public:
  Normal(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}
  double next() {
    const double u = uniform(), v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * v);
  }

 private:
  double uniform() {
    return (static_cast<double>(espdiff::random_bits(seed_, stream_, count_++) >> 11) + 0.5) / 9007199254740992.0;
  }
  std::uint64_t seed_, stream_, count_ = 0;
};

/// An autoregressive series of first order and unit variance: g = (1 + phi) / (1 - phi).
inline std::vector<double> correlated_series(std::size_t n, double phi, Normal& normal) {
  std::vector<double> x(n);
  double value = normal.next();
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = value;
    value = phi * value + std::sqrt(1 - phi * phi) * normal.next();
  }
  return x;
}

/// An ellipsoid: an icosphere divided `levels` times and stretched, 10 * 4^levels + 2 vertices of unequal areas.
inline void make_ellipsoid(int levels, std::vector<espdiff::Vec3d>& positions,
                           std::vector<espdiff::Triangle>& triangles) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
               {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
               {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
               {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::vector<espdiff::Triangle> finer;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> midpoints;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const std::uint64_t key = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
      for (const auto& [edge, vertex] : midpoints) {
        if (edge == key) return vertex;
      }
      positions.push_back(0.5 * (positions[a] + positions[b]));
      midpoints.emplace_back(key, static_cast<std::uint32_t>(positions.size() - 1));
      return midpoints.back().second;
    };
    for (const auto& t : triangles) {
      const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.push_back({t[0], a, c});
      finer.push_back({t[1], b, a});
      finer.push_back({t[2], c, b});
      finer.push_back({a, b, c});
    }
    triangles = finer;
  }
  for (auto& p : positions) p = (1 / norm(p)) * p;
  for (auto& p : positions) p = {20 * p.x, 14 * p.y, 9 * p.z};
}

}  // namespace espdiff_test
