// tetrahedra.h: the Freudenthal division of a cell into tetrahedra, and the triangles of each case, computed at compile
// time.
//
// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1). The six tetrahedra are the monotone paths 0 -> 1 axis ->
// 2 axes -> 7. So every edge joins a corner `low` to a corner that is not smaller along any axis. The edge belongs to
// the lattice point at `low`; its direction 1..7 is the difference. This gives seven candidate vertices per lattice
// point, and cells that share an edge use the same name for it.
#pragma once

#include <array>
#include <cstdint>

#include "base/vector.h"

namespace espdiff {

/// An edge of a cell that carries a vertex: the lattice point at corner `low`, direction 1..7.
struct CellEdge {
  std::uint8_t low;
  std::uint8_t direction;
};

constexpr int kMaxCellTriangles = 12;  ///< two per tetrahedron

/// The triangles of one case; bit c of the case is set if corner c is inside.
struct CellCase {
  std::uint8_t n_triangles = 0;
  CellEdge edges[kMaxCellTriangles][3] = {};  ///< counter-clockwise seen from outside
};

/// [tetrahedron][corner] in path order.
constexpr std::array<std::array<int, 4>, 6> kFreudenthalTetrahedra = {
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

/// Directions in which the edge from the cell's corner 0 crosses the surface; bit d-1 is direction d.
ESPDIFF_HD constexpr std::uint8_t crossing_mask(std::uint8_t cell_case) {
  const unsigned others = static_cast<unsigned>(cell_case) >> 1;
  return static_cast<std::uint8_t>((cell_case & 1U) != 0 ? ~others & 0x7FU : others);
}

namespace detail {

struct IntVec {
  int x, y, z;
};
constexpr IntVec corner_position(int corner) { return {corner & 1, corner >> 1 & 1, corner >> 2 & 1}; }
/// Twice the midpoint of an edge.
constexpr IntVec twice_midpoint(CellEdge e) {
  const IntVec a = corner_position(e.low), b = corner_position(e.low + e.direction);
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr CellEdge make_edge(int a, int b) {
  return a < b ? CellEdge{static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b - a)}
               : CellEdge{static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(a - b)};
}

/// Sign of the triangle's normal along `outward`: positive if counter-clockwise seen from outside.
constexpr int orientation(CellEdge e0, CellEdge e1, CellEdge e2, IntVec outward) {
  const IntVec a = twice_midpoint(e0), b = twice_midpoint(e1), c = twice_midpoint(e2);
  const IntVec u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
  return (u.y * v.z - u.z * v.y) * outward.x + (u.z * v.x - u.x * v.z) * outward.y +
         (u.x * v.y - u.y * v.x) * outward.z;
}

constexpr void add_triangle(CellCase& cell, CellEdge e0, CellEdge e1, CellEdge e2, IntVec outward) {
  const bool turn = orientation(e0, e1, e2, outward) < 0;
  auto& edges = cell.edges[cell.n_triangles++];
  edges[0] = e0;
  edges[1] = turn ? e2 : e1;
  edges[2] = turn ? e1 : e2;
}

constexpr void add_tetrahedron(CellCase& cell, unsigned cell_case, const std::array<int, 4>& corners) {
  int inside[4] = {}, outside[4] = {};
  int n_inside = 0, n_outside = 0;
  for (const int corner : corners) {
    if ((cell_case >> corner & 1U) != 0) {
      inside[n_inside++] = corner;
    } else {
      outside[n_outside++] = corner;
    }
  }
  if (n_inside == 0 || n_outside == 0) return;
  // From the centroid of the inside corners to that of the outside corners, scaled to integers.
  IntVec outward{0, 0, 0};
  for (int i = 0; i < n_outside; ++i) {
    const IntVec p = corner_position(outside[i]);
    outward = {outward.x + n_inside * p.x, outward.y + n_inside * p.y, outward.z + n_inside * p.z};
  }
  for (int i = 0; i < n_inside; ++i) {
    const IntVec p = corner_position(inside[i]);
    outward = {outward.x - n_outside * p.x, outward.y - n_outside * p.y, outward.z - n_outside * p.z};
  }
  if (n_inside == 1) {
    add_triangle(cell, make_edge(inside[0], outside[0]), make_edge(inside[0], outside[1]),
                 make_edge(inside[0], outside[2]), outward);
  } else if (n_outside == 1) {
    add_triangle(cell, make_edge(inside[0], outside[0]), make_edge(inside[1], outside[0]),
                 make_edge(inside[2], outside[0]), outward);
  } else {
    const CellEdge a = make_edge(inside[0], outside[0]), b = make_edge(inside[0], outside[1]);
    const CellEdge c = make_edge(inside[1], outside[1]), d = make_edge(inside[1], outside[0]);
    add_triangle(cell, a, b, c, outward);
    add_triangle(cell, a, c, d, outward);
  }
}

constexpr std::array<CellCase, 256> make_cell_cases() {
  std::array<CellCase, 256> cases{};
  for (unsigned c = 0; c < 256; ++c) {
    for (const auto& tetrahedron : kFreudenthalTetrahedra) add_tetrahedron(cases[c], c, tetrahedron);
  }
  return cases;
}

}  // namespace detail

/// [case] the triangles of a cell.
inline constexpr std::array<CellCase, 256> kCellCases = detail::make_cell_cases();

}  // namespace espdiff
