// tetrahedra.cpp: proves the generated tables: every case, every pair of neighbouring cases, and random blocks.
#include "cuda/surface/tetrahedra.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/shapes.h"
#include "support/random.h"

using espdiff::CellCase;
using espdiff::CellEdge;
using espdiff::kCellCases;
using espdiff::kFreudenthalTetrahedra;
using espdiff::Vec3d;

namespace {

/// A cell's edge as (low corner, high corner); in a larger block, as lattice points.
using Edge = std::pair<int, int>;
using DirectedEdge = std::pair<Edge, Edge>;  // from one surface vertex to the next

Edge ends(CellEdge e) { return {e.low, e.low + e.direction}; }
bool is_inside(int cell_case, int corner) { return (cell_case >> corner & 1) != 0; }
Vec3d corner_at(int corner) {
  return {static_cast<double>(corner & 1), static_cast<double>(corner >> 1 & 1), static_cast<double>(corner >> 2 & 1)};
}
Vec3d middle(CellEdge e) { return 0.5 * (corner_at(ends(e).first) + corner_at(ends(e).second)); }

std::vector<DirectedEdge> directed_edges(const CellCase& cell) {
  std::vector<DirectedEdge> edges;
  for (int t = 0; t < cell.n_triangles; ++t) {
    for (int c = 0; c < 3; ++c) edges.emplace_back(ends(cell.edges[t][c]), ends(cell.edges[t][(c + 1) % 3]));
  }
  return edges;
}

/// The edges of a cell's patch that lie in the face where coordinate `axis` is `side`, with corners moved onto side 0.
std::multiset<DirectedEdge> face_edges(const CellCase& cell, int axis, int side) {
  const auto in_face = [&](Edge e) { return (e.first >> axis & 1) == side && (e.second >> axis & 1) == side; };
  const auto flat = [&](Edge e) { return Edge{e.first & ~(1 << axis), e.second & ~(1 << axis)}; };
  std::multiset<DirectedEdge> found;
  for (const DirectedEdge& e : directed_edges(cell)) {
    if (in_face(e.first) && in_face(e.second)) found.emplace(flat(e.first), flat(e.second));
  }
  return found;
}

bool on_boundary(const DirectedEdge& e) {
  for (int axis = 0; axis < 3; ++axis) {
    const int first = e.first.first >> axis & 1;
    if ((e.first.second >> axis & 1) == first && (e.second.first >> axis & 1) == first &&
        (e.second.second >> axis & 1) == first) {
      return true;
    }
  }
  return false;
}

}  // namespace

TEST_SUITE_BEGIN("tables");

TEST_CASE("the Freudenthal tetrahedra fill the cube") {
  double total = 0;
  for (const auto& t : kFreudenthalTetrahedra) {
    const Vec3d a = corner_at(t[0]);
    const double volume = std::fabs(dot(corner_at(t[1]) - a, cross(corner_at(t[2]) - a, corner_at(t[3]) - a))) / 6;
    CHECK(volume == doctest::Approx(1.0 / 6).epsilon(1e-14));
    total += volume;
  }
  CHECK(total == doctest::Approx(1).epsilon(1e-14));
  // They do not overlap: a point with coordinates in strict order lies in the one tetrahedron whose path adds the axes
  // in that order, and every order occurs once.
  std::set<std::pair<int, int>> paths;
  for (const auto& t : kFreudenthalTetrahedra) {
    CHECK(t[0] == 0);
    CHECK(t[3] == 7);
    CHECK((t[1] & t[2]) == t[1]);
    paths.emplace(t[1], t[2] - t[1]);
  }
  CHECK(paths.size() == 6);
}

TEST_CASE("the vertices of a case are the cell's edges that cross the surface") {
  std::set<Edge> cell_edges;
  for (const auto& t : kFreudenthalTetrahedra) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) cell_edges.emplace(t[i], t[j]);
    }
  }
  CHECK(cell_edges.size() == 19);  // 12 of the cube, 6 face diagonals, 1 of space
  for (int c = 0; c < 256; ++c) {
    std::set<Edge> crossing, used;
    for (const Edge& e : cell_edges) {
      if (is_inside(c, e.first) != is_inside(c, e.second)) crossing.insert(e);
    }
    for (const DirectedEdge& e : directed_edges(kCellCases[static_cast<std::size_t>(c)])) used.insert(e.first);
    CAPTURE(c);
    CHECK(used == crossing);
  }
}

TEST_CASE("the crossing mask names the directions from corner 0 that cross") {
  for (int c = 0; c < 256; ++c) {
    const unsigned mask = espdiff::crossing_mask(static_cast<std::uint8_t>(c));
    for (int direction = 1; direction < 8; ++direction) {
      CAPTURE(c);
      CHECK(((mask >> (direction - 1) & 1U) != 0) == (is_inside(c, 0) != is_inside(c, direction)));
    }
  }
}

TEST_CASE("a case has 0 to 12 triangles, as many as its tetrahedra need") {
  int most = 0;
  for (int c = 0; c < 256; ++c) {
    int expected = 0;
    for (const auto& t : kFreudenthalTetrahedra) {
      const auto n = std::count_if(t.begin(), t.end(), [&](int corner) { return is_inside(c, corner); });
      expected += n == 2 ? 2 : n == 1 || n == 3 ? 1 : 0;
    }
    CAPTURE(c);
    CHECK(kCellCases[static_cast<std::size_t>(c)].n_triangles == expected);
    most = std::max(most, expected);
  }
  CHECK(kCellCases[0].n_triangles == 0);
  CHECK(kCellCases[255].n_triangles == 0);
  CHECK(most == espdiff::kMaxCellTriangles);
}

TEST_CASE("triangles are counter-clockwise seen from outside") {
  for (const CellCase& cell : kCellCases) {
    const int c = static_cast<int>(&cell - kCellCases.data());
    for (int t = 0; t < cell.n_triangles; ++t) {
      const auto& e = cell.edges[t];
      const Vec3d normal = cross(middle(e[1]) - middle(e[0]), middle(e[2]) - middle(e[0]));
      CAPTURE(c);
      CHECK(norm(normal) > 0);
      for (const CellEdge& edge : e) {
        const Edge at = ends(edge);
        const Vec3d outward = (is_inside(c, at.first) ? 1.0 : -1.0) * (corner_at(at.second) - corner_at(at.first));
        CHECK(dot(normal, outward) > 0);
      }
    }
  }
}

TEST_CASE("within a cell every edge of the patch has its opposite, except on the cell's faces") {
  for (const CellCase& cell : kCellCases) {
    std::multiset<DirectedEdge> edges;
    for (const DirectedEdge& e : directed_edges(cell)) edges.insert(e);
    for (const DirectedEdge& e : edges) {
      CAPTURE(&cell - kCellCases.data());
      CHECK(edges.count(e) == 1);
      CHECK(edges.count({e.second, e.first}) == (on_boundary(e) ? 0 : 1));
    }
  }
}

TEST_CASE("the patches of neighbouring cells meet on their face with opposite edges, in all 3 x 4096 pairs of cases") {
  int n_mismatches = 0, n_pairs = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int low_case = 0; low_case < 256; ++low_case) {
      for (int far_corners = 0; far_corners < 16; ++far_corners) {
        // The high cell takes its face from the low cell and its other four corners from `far_corners`.
        int high_case = 0, n_far = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const bool far_side = (corner >> axis & 1) != 0;
          const bool inside = far_side ? (far_corners >> n_far & 1) != 0 : is_inside(low_case, corner | 1 << axis);
          if (far_side) ++n_far;
          high_case |= (inside ? 1 : 0) << corner;
        }
        const auto low = face_edges(kCellCases[static_cast<std::size_t>(low_case)], axis, 1);
        auto high = face_edges(kCellCases[static_cast<std::size_t>(high_case)], axis, 0);
        std::multiset<DirectedEdge> opposite;
        for (const DirectedEdge& e : low) opposite.emplace(e.second, e.first);
        n_mismatches += opposite == high ? 0 : 1;
        ++n_pairs;
      }
    }
  }
  CHECK(n_pairs == 3 * 4096);
  CHECK(n_mismatches == 0);
}

TEST_CASE("blocks of random points give closed manifolds of even Euler characteristic") {
  espdiff_test::Random random(1);
  constexpr int kSide = 6;  // 4 x 4 x 4 random points within a border outside
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<bool> inside(kSide * kSide * kSide, false);
    const double share = random.uniform(0.05, 0.95);
    const auto point = [](int i, int j, int k) { return i + kSide * (j + kSide * k); };
    for (int k = 1; k < kSide - 1; ++k) {
      for (int j = 1; j < kSide - 1; ++j) {
        for (int i = 1; i < kSide - 1; ++i) inside[static_cast<std::size_t>(point(i, j, k))] = random.uniform() < share;
      }
    }
    espdiff::Mesh mesh;
    std::map<Edge, std::uint32_t> vertex;
    for (int cell = 0; cell < kSide * kSide * kSide; ++cell) {
      const int i = cell % kSide, j = cell / kSide % kSide, k = cell / (kSide * kSide);
      if (i == kSide - 1 || j == kSide - 1 || k == kSide - 1) continue;
      const auto at = [&](int corner) { return point(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1)); };
      std::size_t cell_case = 0;
      for (int corner = 0; corner < 8; ++corner) {
        if (inside[static_cast<std::size_t>(at(corner))]) cell_case |= std::size_t{1} << corner;
      }
      for (int t = 0; t < kCellCases[cell_case].n_triangles; ++t) {
        espdiff::Triangle triangle{};
        for (std::size_t c = 0; c < 3; ++c) {
          const Edge e = ends(kCellCases[cell_case].edges[t][c]);
          const auto [entry, is_new] =
              vertex.try_emplace(Edge{at(e.first), at(e.second)}, static_cast<std::uint32_t>(vertex.size()));
          if (is_new) {
            const Vec3d origin{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
            mesh.positions.push_back(static_cast<espdiff::Vec3f>(origin + middle(kCellCases[cell_case].edges[t][c])));
          }
          triangle[c] = entry->second;
        }
        mesh.triangles.push_back(triangle);
      }
    }
    CAPTURE(trial);
    CHECK(espdiff_test::manifold_fault(mesh) == "");
    CHECK(espdiff_test::euler_characteristic(mesh) % 2 == 0);
    if (!mesh.triangles.empty()) CHECK(espdiff_test::signed_volume(mesh) > 0);
  }
}

TEST_SUITE_END();
