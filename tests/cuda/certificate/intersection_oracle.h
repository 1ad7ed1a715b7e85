// intersection_oracle.h: intersecting pairs of triangles counted in integers, by separating axes, all against all.
//
// Another method than the engine's: two convex polygons are disjoint exactly if their projections onto one of a known
// set of axes are (Gottschalk et al., SIGGRAPH 1996). On a lattice nothing is rounded.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "support/random.h"

namespace espdiff_test {

using LatticePoint = espdiff::Vec3<std::int64_t>;

/// Corners on a lattice, |coordinate| <= 1024 so that products of five coordinates fit into 64 bits.
struct LatticeMesh {
  std::vector<LatticePoint> points;
  std::vector<espdiff::Triangle> triangles;
};

/// The mesh with positions that are whole multiples of `unit`, a power of two, as floats hold them.
inline Mesh placed(const LatticeMesh& lattice, double unit = 1, LatticePoint shift = {}) {
  Mesh mesh;
  for (const LatticePoint& p : lattice.points)
    mesh.positions.push_back(static_cast<Vec3f>(unit * static_cast<Vec3d>(p + shift)));
  mesh.triangles = lattice.triangles;
  return mesh;
}

inline LatticePoint snapped(Vec3d p) { return {std::llround(p.x), std::llround(p.y), std::llround(p.z)}; }

/// The mesh with its corners on the nearest multiples of 1 / per_unit.
inline LatticeMesh snapped(const Mesh& mesh, double per_unit) {
  LatticeMesh lattice;
  for (const Vec3f& p : mesh.positions) lattice.points.push_back(snapped(per_unit * static_cast<Vec3d>(p)));
  lattice.triangles = mesh.triangles;
  return lattice;
}

using Polygon = std::vector<LatticePoint>;

inline bool apart_along(LatticePoint axis, const Polygon& p, const Polygon& q) {
  const auto range = [&](const Polygon& polygon) {
    std::int64_t low = dot(axis, polygon[0]), high = low;
    for (const LatticePoint& point : polygon) {
      low = std::min(low, dot(axis, point));
      high = std::max(high, dot(axis, point));
    }
    return std::pair(low, high);
  };
  const auto [p_low, p_high] = range(p);
  const auto [q_low, q_high] = range(q);
  return p_high < q_low || q_high < p_low;
}

/// Whether two triangles, or a segment and a triangle, have a point in common.
inline bool have_common_point(const Polygon& p, const Polygon& q) {
  const auto edges = [](const Polygon& polygon) {
    Polygon result;
    for (std::size_t i = 0; i < polygon.size(); ++i) result.push_back(polygon[(i + 1) % polygon.size()] - polygon[i]);
    return result;
  };
  const Polygon edges_p = edges(p), edges_q = edges(q);
  Polygon axes;
  for (const auto* of : {&edges_p, &edges_q}) {
    const LatticePoint normal = cross((*of)[0], (*of)[1]);  // zero for a segment
    axes.push_back(normal);
    for (const auto* other : {&edges_p, &edges_q})
      for (const LatticePoint& edge : *other) axes.push_back(cross(normal, edge));
  }
  for (const LatticePoint& a : edges_p)
    for (const LatticePoint& b : edges_q) axes.push_back(cross(a, b));
  return std::none_of(axes.begin(), axes.end(), [&](LatticePoint axis) { return apart_along(axis, p, q); });
}

/// Whether triangles t and u intersect in Engine::self_intersections()' sense.
inline bool intersect_oracle(const LatticeMesh& mesh, const espdiff::Triangle& t, const espdiff::Triangle& u) {
  Polygon own_t, own_u, shared;  // vertices of one triangle only, and shared ones
  for (const std::uint32_t v : t) (std::count(u.begin(), u.end(), v) > 0 ? shared : own_t).push_back(mesh.points[v]);
  for (const std::uint32_t v : u)
    if (std::count(t.begin(), t.end(), v) == 0) own_u.push_back(mesh.points[v]);
  const auto all = [&](Polygon own) {
    own.insert(own.end(), shared.begin(), shared.end());
    return own;
  };
  if (shared.size() == 3) return true;
  if (shared.size() == 2) {
    const LatticePoint edge = shared[1] - shared[0];
    const LatticePoint n_t = cross(edge, own_t[0] - shared[0]), n_u = cross(edge, own_u[0] - shared[0]);
    return cross(n_t, n_u) == LatticePoint{} && dot(n_t, n_u) > 0;
  }
  if (shared.size() == 1) return have_common_point(own_t, all(own_u)) || have_common_point(all(own_t), own_u);
  return have_common_point(own_t, own_u);
}

struct OracleReport {
  std::size_t n_pairs = 0, n_degenerate = 0;
  std::vector<float> intersecting;
};

inline OracleReport intersections_oracle(const LatticeMesh& mesh) {
  const auto has_area = [&](const espdiff::Triangle& t) {
    const LatticePoint a = mesh.points[t[0]];
    return !(cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a) == LatticePoint{});
  };
  OracleReport report;
  report.intersecting.assign(mesh.triangles.size(), 0.0F);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!has_area(mesh.triangles[i])) {
      report.intersecting[i] = 1;
      ++report.n_degenerate;
      ++report.n_pairs;
      continue;
    }
    for (std::size_t j = i + 1; j < mesh.triangles.size(); ++j) {
      if (!has_area(mesh.triangles[j]) || !intersect_oracle(mesh, mesh.triangles[i], mesh.triangles[j])) continue;
      report.intersecting[i] = report.intersecting[j] = 1;
      ++report.n_pairs;
    }
  }
  return report;
}

/// Both meshes as one.
template <typename AnyMesh, typename Points>
void append(AnyMesh& mesh, Points AnyMesh::*points, const AnyMesh& other) {
  const auto first = static_cast<std::uint32_t>((mesh.*points).size());
  (mesh.*points).insert((mesh.*points).end(), (other.*points).begin(), (other.*points).end());
  for (const espdiff::Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

inline LatticeMesh joined(LatticeMesh mesh, const LatticeMesh& other) {
  append(mesh, &LatticeMesh::points, other);
  return mesh;
}
inline Mesh joined(Mesh mesh, const Mesh& other) {
  append(mesh, &Mesh::positions, other);
  return mesh;
}

/// A closed surface of four triangles.
inline LatticeMesh tetrahedron(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
  return {{a, b, c, d}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
}

/// Tetrahedra and spheres of twenty triangles with their corners anywhere on a lattice of (2 half_side + 1)^3 points:
/// the smaller, the more of them touch, overlap in a plane, or have no area.
inline LatticeMesh random_lattice_soup(Random& random, int n_bodies, std::int64_t half_side) {
  const auto point = [&] {
    const auto coordinate = [&] {
      return static_cast<std::int64_t>(random.below(static_cast<std::size_t>(2 * half_side + 1))) - half_side;
    };
    const std::int64_t x = coordinate(), y = coordinate();
    return LatticePoint{x, y, coordinate()};
  };
  LatticeMesh soup;
  for (int body = 0; body < n_bodies; ++body) {
    LatticeMesh next = body % 3 == 0 ? snapped(icosphere(0, 1.0), 1) : tetrahedron({}, {}, {}, {});
    for (LatticePoint& p : next.points) p = point();
    soup = joined(soup, next);
  }
  return soup;
}

}  // namespace espdiff_test
