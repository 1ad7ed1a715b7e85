// oracles.h: serial, double-precision, brute-force forms of the engine's computations.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cuda/surface/shapes.h"
#include "engine/certificate_stage.h"

namespace espdiff_test {

/// The untruncated density, thesis eq. 3.1.
inline double density_oracle(const AtomSet& atoms, Vec3d p) {
  double sum = 0;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const double s = static_cast<double>(atoms.widths[i]);
    if (!(s > 0)) continue;
    const Vec3d d = p - atoms.positions[i];
    sum += std::exp(-dot(d, d) / (2 * s * s));
  }
  return sum;
}

/// Distance of a point to a triangle: the nearest of the foot within the face, the edges and the corners, after
/// Ericson, Real-Time Collision Detection (2005), section 5.1.5, by the regions of the plane.
inline double triangle_distance_oracle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return norm(ap);
  const Vec3d bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return norm(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return norm(ap - (d1 / (d1 - d3)) * ab);
  const Vec3d cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return norm(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return norm(ap - (d2 / (d2 - d6)) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return norm(bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b));
  return norm(ap - (vb / (va + vb + vc)) * ab - (vc / (va + vb + vc)) * ac);
}

/// Distance of a point to the nearest triangle of a mesh; unsigned.
inline double mesh_distance_oracle(const Mesh& mesh, Vec3d p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles) {
    const Vec3d a = static_cast<Vec3d>(mesh.positions[t[0]]), b = static_cast<Vec3d>(mesh.positions[t[1]]);
    const Vec3d c = static_cast<Vec3d>(mesh.positions[t[2]]);
    // A bounding sphere rules out most triangles.
    const double reach = std::max(norm(b - a), norm(c - a));
    if (norm(p - a) - reach < nearest) nearest = std::min(nearest, triangle_distance_oracle(p, a, b, c));
  }
  return nearest;
}

inline double triangle_area(const Mesh& mesh, const espdiff::Triangle& t) {
  const Vec3d a = static_cast<Vec3d>(mesh.positions[t[0]]);
  return 0.5 * norm(cross(static_cast<Vec3d>(mesh.positions[t[1]]) - a, static_cast<Vec3d>(mesh.positions[t[2]]) - a));
}

inline double area_oracle(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) sum += triangle_area(mesh, t);
  return sum;
}

/// [vertex] a third of the area of the incident triangles that satisfy counts(triangle index).
template <typename Counts>
std::vector<double> vertex_weights(const Mesh& mesh, Counts counts) {
  std::vector<double> weights(mesh.positions.size(), 0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!counts(t)) continue;
    for (const std::uint32_t v : mesh.triangles[t]) weights[v] += triangle_area(mesh, mesh.triangles[t]) / 3;
  }
  return weights;
}

/// Mean, 95 % and largest distance of a's vertices to b's triangles, area-weighted.
inline espdiff::DistanceSummary distances_oracle(const Mesh& a, const Mesh& b, double limit) {
  const std::vector<double> weights = vertex_weights(a, [](std::size_t) { return true; });
  std::vector<std::pair<double, double>> by_distance;
  double area = 0;
  espdiff::DistanceSummary summary;
  const auto add = [&](const Vec3d& p, double weight) {
    const double d = mesh_distance_oracle(b, p);
    by_distance.emplace_back(d, weight);
    area += weight;
    summary.mean += weight * d;
    summary.max = std::max(summary.max, d);
    if (d > limit) summary.area_fraction_beyond_limit += weight;
  };
  for (std::size_t v = 0; v < weights.size(); ++v) add(static_cast<Vec3d>(a.positions[v]), 0.25 * weights[v]);
  for (const auto& t : a.triangles) {
    const auto p = static_cast<Vec3d>(a.positions[t[0]]), q = static_cast<Vec3d>(a.positions[t[1]]),
               r = static_cast<Vec3d>(a.positions[t[2]]);
    add((1.0 / 3) * (p + q + r), 0.75 * 0.5 * norm(cross(q - p, r - p)));
  }
  summary.mean /= area;
  summary.area_fraction_beyond_limit /= area;
  std::sort(by_distance.begin(), by_distance.end());
  double below = 0;
  for (const auto& [d, w] : by_distance) {
    summary.p95 = d;
    if ((below += w) >= 0.95 * area) break;
  }
  return summary;
}

}  // namespace espdiff_test
