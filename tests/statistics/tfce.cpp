// tfce.cpp: cluster enhancement against the sum over thresholds, patches, and areas.
#include "statistics/surface/tfce.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/planted_columns.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/patches.h"

using namespace espdiff;
using espdiff_test::make_ellipsoid;
using espdiff_test::Normal;

namespace {

MeshGraph ellipsoid(int levels) {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  make_ellipsoid(levels, positions, triangles);
  return make_mesh_graph(positions, triangles);
}

std::vector<double> noise(std::size_t n, std::uint64_t stream) {
  Normal normal(21, stream);
  std::vector<double> values(n);
  for (double& value : values) value = normal.next();
  return values;
}

/// The definition, with midpoints of many thresholds and a flood fill at each.
std::vector<double> by_thresholds(const std::vector<double>& values, const MeshGraph& graph, int n_steps) {
  double highest = 0;
  for (const double v : values) highest = std::isfinite(v) ? std::max(highest, std::fabs(v)) : highest;
  std::vector<double> scores(values.size(), 0);
  const double dh = highest / n_steps;
  for (int k = 0; k < n_steps; ++k) {
    const double h = (k + 0.5) * dh;
    std::vector<double> p(values.size(), 1);
    for (std::size_t v = 0; v < values.size(); ++v) p[v] = std::fabs(values[v]) >= h ? 0 : 1;  // NaN: 1
    for (const SignificantPatch& patch : find_patches(p, values, 0.5, graph)) {
      for (const std::uint32_t v : patch.vertices)
        scores[v] += (values[v] > 0 ? 1 : -1) * std::sqrt(patch.area) * h * h * dh;
    }
  }
  return scores;
}

}  // namespace

TEST_SUITE_BEGIN("tfce");

TEST_CASE("scores are the integral over thresholds") {
  const MeshGraph graph = ellipsoid(3);
  std::vector<double> values = noise(graph.n_vertices(), 1);
  values[17] = values[200] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> exact = enhance_clusters(values, graph), slow = by_thresholds(values, graph, 4000);
  double largest = 0, worst = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    largest = std::max(largest, std::fabs(slow[v]));
    worst = std::max(worst, std::fabs(slow[v] - exact[v]));
  }
  CHECK(worst < 2e-3 * largest);
  CHECK(exact[17] == 0);
}

TEST_CASE("a plateau has the analytic score") {
  const MeshGraph graph = ellipsoid(2);
  double area = 0;
  for (const double a : graph.area) area += a;
  const std::vector<double> scores = enhance_clusters(std::vector<double>(graph.n_vertices(), -3.0), graph);
  for (const double score : scores) CHECK(score == doctest::Approx(-std::sqrt(area) * 9).epsilon(1e-9));
}

TEST_CASE("scores turn their sign with the values, bit for bit") {
  const MeshGraph graph = ellipsoid(3);
  std::vector<double> values = noise(graph.n_vertices(), 2);
  const std::vector<double> scores = enhance_clusters(values, graph);
  for (double& value : values) value = -value;
  const std::vector<double> turned = enhance_clusters(values, graph);
  for (std::size_t v = 0; v < scores.size(); ++v) CHECK(turned[v] == -scores[v]);
}

TEST_CASE("vertices' areas sum to the surface's, and neighbours are mutual") {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  make_ellipsoid(2, positions, triangles);
  const MeshGraph graph = make_mesh_graph(positions, triangles);
  double area = 0, by_vertices = 0;
  for (const Triangle& t : triangles)
    area += norm(cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]])) / 2;
  for (const double a : graph.area) by_vertices += a;
  CHECK(by_vertices == doctest::Approx(area));
  CHECK(graph.n_vertices() == 162);
  CHECK(graph.neighbours.size() == 3 * triangles.size());  // a closed surface has 3/2 edges a triangle
}

TEST_CASE("patches are connected, of one sign, the largest first") {
  const MeshGraph graph = ellipsoid(2);
  std::vector<double> p(graph.n_vertices(), 1), values(graph.n_vertices(), 1);
  const auto mark = [&](std::uint32_t v, double value) {
    p[v] = 0.01;
    values[v] = value;
    for (std::uint32_t n = graph.first[v]; n < graph.first[v + 1]; ++n) {
      p[graph.neighbours[n]] = 0.04;
      values[graph.neighbours[n]] = value / 2;
    }
  };
  mark(0, 4);
  mark(3, -2);  // the opposite vertex of the icosahedron
  p[0] = 0.01;
  const std::uint32_t alone = 30;
  REQUIRE(p[alone] == 1);
  p[alone] = 0.05;
  const std::vector<SignificantPatch> patches = find_patches(p, values, 0.05, graph);
  REQUIRE(patches.size() >= 2);
  CHECK(patches[0].area >= patches[1].area);
  CHECK(patches[0].vertices.size() >= 6);
  for (const SignificantPatch& patch : patches) {
    for (const std::uint32_t v : patch.vertices) CHECK((values[v] > 0) == (values[patch.peak] > 0));
  }
  CHECK(find_patches(p, values, 0.001, graph).empty());
}

TEST_SUITE_END();
