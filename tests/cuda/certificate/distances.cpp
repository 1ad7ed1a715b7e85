// distances.cpp: distances between surfaces against a brute-force search in double precision.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "cuda/surface/read_atoms.h"
#include "engine/certificate_stage.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::DistanceSummary;
using espdiff::FitReport;

namespace {

Mesh random_potato(int levels, double radius, double noise, std::uint64_t seed, Vec3d centre = {}) {
  Random random(seed);
  return moved(icosphere(levels, radius, centre), [&](Vec3d p) { return p + random.in_box(noise); });
}

/// The distance of one point to a mesh: one vertex has all the area of a mesh whose other vertices lie in the target.
double point_distance(Engine& engine, Vec3d p, const Mesh& target) {
  Mesh probe;  // a tetrahedron around p: every corner at p but for rounding would have no area, so measure the maximum
  const double e = 1e-4;
  probe.positions = {static_cast<Vec3f>(p), static_cast<Vec3f>(p + Vec3d{e, 0, 0}),
                     static_cast<Vec3f>(p + Vec3d{0, e, 0}), static_cast<Vec3f>(p + Vec3d{0, 0, e})};
  probe.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return engine.distances(engine.upload_mesh(probe), engine.upload_mesh(target), 1).max;
}

void check_summary(const DistanceSummary& found, const DistanceSummary& exact) {
  CHECK(found.max == doctest::Approx(exact.max).epsilon(1e-5));
  CHECK(found.mean == doctest::Approx(exact.mean).epsilon(1e-5));
  // The 95 % quantile may fall within a vertex; the next vertex's distance differs little.
  CHECK(found.p95 == doctest::Approx(exact.p95).epsilon(1e-3));
  CHECK(found.area_fraction_beyond_limit == doctest::Approx(exact.area_fraction_beyond_limit).epsilon(1e-3));
}

}  // namespace

TEST_SUITE_BEGIN("distances");

TEST_CASE("distances between random meshes are those of a brute-force search") {
  for (const auto& engine : back_ends()) {
    for (std::uint64_t seed = 70; seed < 78; ++seed) {
      const int levels = static_cast<int>(seed % 4);  // 20 to 1280 triangles: trees of one leaf to hundreds
      const Mesh a = random_potato(3, 4.0, 0.5, seed),
                 b = random_potato(levels, 4.3, 0.4, seed + 100, {0.3, -0.5, 0.2});
      CAPTURE(seed);
      check_summary(engine->distances(engine->upload_mesh(a), engine->upload_mesh(b), 0.7),
                    distances_oracle(a, b, 0.7));
    }
    // Far apart, so that the tree's boxes are uninformative.
    const Mesh a = random_potato(2, 2.0, 0.2, 78), b = random_potato(3, 3.0, 0.3, 79, {40, 5, -9});
    check_summary(engine->distances(engine->upload_mesh(a), engine->upload_mesh(b), 30), distances_oracle(a, b, 30));
  }
}

TEST_CASE("fit and distances of a part follow from those of the whole, bit by bit") {
  const Mesh mesh = random_potato(3, 4.0, 0.5, 81), other = random_potato(2, 4.3, 0.4, 82);
  for (const auto& engine : back_ends()) {
    const auto whole = engine->upload_mesh(mesh), to = engine->upload_mesh(other);
    const auto atoms = upload(*engine, one_gaussian({0, 0, 0}, 2));
    const FitReport fit = engine->fit(whole, atoms, 0.5F);
    const DistanceSummary distances = engine->distances(whole, to, 1);
    std::vector<float> removed;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) removed.push_back(t % 7 < 3 || t > 900 ? 1.0F : 0.0F);
    const auto flags = engine->upload_scalars(removed);
    const auto part = engine->without(whole, flags);
    const FitReport again = engine->fit(part, atoms, 0.5F), kept = engine->fit_without(part, fit, flags);
    CHECK(kept.area_A2 == again.area_A2);
    CHECK(kept.corrupt_area_fraction == again.corrupt_area_fraction);
    CHECK(kept.flipped_area_fraction == again.flipped_area_fraction);
    CHECK(engine->download(kept.corrupt) == engine->download(again.corrupt));
    CHECK(engine->download(kept.flipped) == engine->download(again.flipped));
    const DistanceSummary anew = engine->distances(part, to, 1),
                          left = engine->distances_without(part, whole, distances, flags, 1);
    CHECK(engine->download(left.distances) == engine->download(anew.distances));
    CHECK(engine->download(left.beyond) == engine->download(anew.beyond));
    CHECK(std::vector<double>{left.mean, left.p95, left.max, left.area_fraction_beyond_limit, left.mean_within_limit} ==
          std::vector<double>{anew.mean, anew.p95, anew.max, anew.area_fraction_beyond_limit, anew.mean_within_limit});
    CHECK_THROWS_WITH_AS(engine->fit_without(whole, fit, flags),
                         "the part has another number of triangles than remain of the whole", espdiff::GeometryError);
  }
}

TEST_CASE("concentric spheres lie apart by the difference of their radii") {
  for (const auto& engine : back_ends()) {
    const auto inner = engine->upload_mesh(icosphere(4, 5.0)), outer = engine->upload_mesh(icosphere(4, 5.5));
    const DistanceSummary d = engine->distances(inner, outer, 0.4);
    // The inner vertices see the outer sphere's chords, up to 5.5 (1 - cos(half an edge's angle)) nearer than the
    // sphere.
    CHECK(d.max < 0.5 + 1e-5);
    CHECK(d.mean > 0.49);
    CHECK(d.area_fraction_beyond_limit == doctest::Approx(1.0));
    const DistanceSummary self = engine->distances(inner, inner, 0.4);
    CHECK(self.max < 1e-6);
    CHECK(self.area_fraction_beyond_limit == 0);
  }
}

TEST_CASE("a point finds the face, each edge and each corner of a triangle") {
  // A flat tetrahedron: its base is the triangle to test, the fourth corner far below.
  Mesh target;
  target.positions = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {1, 1, -50}};
  target.triangles = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
  const struct {
    const char* where;
    Vec3d point;
    double distance;
  } cases[] = {
      {"face", {1, 1, 2}, 2},
      {"face, near an edge", {1.999, 1.5, 1}, 1},
      {"edge 0-1", {2, -3, 4}, 5},
      {"edge 0-2", {-6, 1, 8}, 10},
      {"edge 1-2", {2 + 0.6 * 5, 1.5 + 0.8 * 5, 12}, 13},
      {"corner 0", {-2, -3, 6}, 7},
      {"corner 1", {4 + 6, -2, 3}, 7},
      {"corner 2", {-1, 3 + 4, 8}, 9},
      {"on the face", {1, 0.5, 0}, 0},
      {"on a corner", {4, 0, 0}, 0},
  };
  for (const auto& engine : back_ends()) {
    for (const auto& c : cases) {
      CAPTURE(std::string(c.where));
      CHECK(triangle_distance_oracle(c.point, {0, 0, 0}, {4, 0, 0}, {0, 3, 0}) ==
            doctest::Approx(c.distance).epsilon(1e-12));
      CHECK(std::fabs(point_distance(*engine, c.point, target) - c.distance) < 2e-4);  // the probe's own size
    }
  }
}

TEST_CASE("degenerate triangles count as segments and points") {
  Mesh target = icosphere(1, 3.0);
  for (const std::uint32_t v : target.triangles[0])
    target.positions[v] = target.positions[target.triangles[0][0]];  // a point
  const auto& t = target.triangles[40];
  target.positions[t[1]] = 0.5F * (target.positions[t[0]] + target.positions[t[2]]);  // a segment
  const Mesh probe = random_potato(3, 3.2, 0.3, 80);
  for (const auto& engine : back_ends()) {
    check_summary(engine->distances(engine->upload_mesh(probe), engine->upload_mesh(target), 0.2),
                  distances_oracle(probe, target, 0.2));
  }
}

TEST_CASE("distances between real surfaces are exact") {
  const auto path = real_input("ubq/ubq.pqr"), other = real_input("series19_ubq_2k39/m03.pqr");
  if (!path) return;
  const AtomSet atoms = read_atoms(*path), other_atoms = read_atoms(*other);
  for (const auto& engine : back_ends()) {
    const auto a = engine->isosurface(engine->density(upload(*engine, atoms), 1.0), 0.5F);
    const auto b = engine->isosurface(engine->density(upload(*engine, other_atoms), 1.0), 0.5F);
    const Mesh b_mesh = engine->download(b);
    // A sparse sample of a's vertices, as the corners of small tetrahedra, keeps the brute force short.
    const Mesh a_mesh = engine->download(a);
    double worst = 0, largest = 0;
    Mesh probes;
    for (std::size_t v = 0; v < a_mesh.positions.size(); v += 97) {
      const std::uint32_t first = static_cast<std::uint32_t>(probes.positions.size());
      for (const Vec3f& shift : {Vec3f{}, Vec3f{0.01F, 0, 0}, Vec3f{0, 0.01F, 0}, Vec3f{0, 0, 0.01F}}) {
        probes.positions.push_back(a_mesh.positions[v] + shift);
      }
      for (const auto& t : {espdiff::Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
        probes.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      }
    }
    const DistanceSummary found = engine->distances(engine->upload_mesh(probes), b, 1.0),
                          exact = distances_oracle(probes, b_mesh, 1.0);
    worst = std::fabs(found.mean - exact.mean);
    largest = std::fabs(found.max - exact.max);
    std::printf("distances, %s: mean %.4f A (off by %.1e), max %.4f A (off by %.1e)\n", engine->back_end().c_str(),
                found.mean, worst, found.max, largest);
    CHECK(worst < 1e-5);
    CHECK(largest < 1e-5);
  }
}

TEST_SUITE_END();
