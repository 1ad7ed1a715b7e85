// intersections.cpp: pairs of intersecting triangles: known numbers, degenerate ones, against integers.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "cuda/certificate/intersection_oracle.h"
#include "cuda/surface/read_atoms.h"
#include "engine/certificate_stage.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::IntersectionReport;

namespace {

std::size_t n_pairs(Engine& engine, const Mesh& mesh) {
  return engine.self_intersections(engine.upload_mesh(mesh)).n_pairs;
}

void check_against_oracle(Engine& engine, const LatticeMesh& lattice, const Mesh& mesh, const OracleReport& expected) {
  REQUIRE(lattice.triangles.size() == mesh.triangles.size());
  const IntersectionReport report = engine.self_intersections(engine.upload_mesh(mesh));
  CHECK(report.n_pairs == expected.n_pairs);
  CHECK(report.n_degenerate == expected.n_degenerate);
  CHECK(engine.download(report.intersecting) == expected.intersecting);
}

void check_against_oracle(Engine& engine, const LatticeMesh& lattice) {
  check_against_oracle(engine, lattice, placed(lattice), intersections_oracle(lattice));
}

/// A corner of the one pokes by `depth` lattice units through the slanted face x + y + z = 400 of the other.
LatticeMesh poking_tetrahedra(std::int64_t depth) {
  const LatticePoint tip = {100 - depth, 100 - depth, 200 - depth};
  return joined(tetrahedron({0, 0, 0}, {0, 400, 0}, {400, 0, 0}, {0, 0, 400}),
                tetrahedron(tip, tip + LatticePoint{300, 310, 200}, tip + LatticePoint{200, 300, 330},
                            tip + LatticePoint{310, 200, 290}));
}

/// A sphere with one vertex pushed through the opposite side.
Mesh pierced_sphere() {
  Mesh mesh = icosphere(3, 8.0);
  mesh.positions[0] = -1.3F * mesh.positions[0] + Vec3f{0.11F, 0.07F, 0.05F};
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("intersections");

TEST_CASE("a sphere, one within another, and two apart have no intersecting triangles") {
  for (const auto& engine : back_ends()) {
    for (int levels = 0; levels <= 4; ++levels) CHECK(n_pairs(*engine, icosphere(levels, 5.0)) == 0);
    const Mesh sphere = icosphere(3, 5.0);
    CHECK(n_pairs(*engine, joined(sphere, turned(icosphere(3, 4.0)))) == 0);
    CHECK(n_pairs(*engine, joined(sphere, icosphere(3, 5.0, {10.5, 1, 2}))) == 0);
    const IntersectionReport report = engine->self_intersections(engine->upload_mesh(sphere));
    CHECK(engine->download(report.intersecting) == std::vector<float>(sphere.triangles.size(), 0.0F));
  }
}

TEST_CASE("a corner through a face makes three pairs, on it three, one float short of it none") {
  for (const auto& engine : back_ends()) {
    CHECK(n_pairs(*engine, placed(poking_tetrahedra(10))) == 3);
    CHECK(n_pairs(*engine, placed(poking_tetrahedra(0))) == 3);
    CHECK(n_pairs(*engine, placed(poking_tetrahedra(-1))) == 0);
    // The tip, vertex 4, lies exactly on the face; the next float beside it does not.
    for (const bool outward : {true, false}) {
      Mesh mesh = placed(poking_tetrahedra(0));
      mesh.positions[4].y = std::nextafter(mesh.positions[4].y, outward ? 1000.0F : -1000.0F);
      CHECK(n_pairs(*engine, mesh) == (outward ? 0 : 3));
    }
    const IntersectionReport report = engine->self_intersections(engine->upload_mesh(placed(poking_tetrahedra(10))));
    CHECK(engine->download(report.intersecting) == std::vector<float>{0, 0, 0, 1, 1, 1, 1, 0});
  }
}

TEST_CASE("triangles that go around a vertex twice, or turn back on the way, intersect as counted in integers") {
  const auto engines = back_ends();
  Random random(311);
  for (int round = 0; round < 60; ++round) {
    // Two tips, and a ring that goes around them `n_turns` times and sometimes back.
    const int n_turns = 1 + round % 3;
    const std::uint32_t n = static_cast<std::uint32_t>(3 + 3 * n_turns + round % 5);
    LatticeMesh body;
    for (std::uint32_t i = 0; i < n; ++i) {
      const double along = static_cast<double>(i) + (round % 4 == 3 ? 3 * random.uniform() : 0.0);
      const double angle = 2 * 3.14159265358979 * n_turns * along / n, radius = 200 + 100 * random.uniform();
      body.points.push_back(snapped({radius * std::cos(angle), radius * std::sin(angle), 80 * random.uniform()}));
    }
    body.points.push_back({3, 5, 300});
    body.points.push_back({-2, 4, -300});
    for (std::uint32_t i = 0; i < n; ++i) {
      body.triangles.push_back({i, (i + 1) % n, n});
      body.triangles.push_back({(i + 1) % n, i, n + 1});
    }
    CAPTURE(round);
    const OracleReport expected = intersections_oracle(body);
    if (n_turns > 1) CHECK(expected.n_pairs > 0);
    for (const auto& engine : engines) check_against_oracle(*engine, body, placed(body), expected);
  }
}

TEST_CASE("a corner exactly on a face is found there though its determinant has more bits than a double") {
  Random random(304);
  const auto point = [&](double half_side) { return static_cast<Vec3d>(snapped(random.in_box(half_side))); };
  const auto engines = back_ends();
  for (int round = 0; round < 200; ++round) {
    const Vec3d a = 4.0 * point(1 << 20), b = 4.0 * point(1 << 20), c = 4.0 * point(1 << 20);
    const Vec3d tip = a + 0.5 * (b - a) + 0.25 * (c - a);  // whole numbers below 2^23
    const Vec3d normal = cross(b - a, c - a);
    if (norm(normal) < 1e12) continue;
    const Vec3d outward = (2e6 / norm(normal)) * normal;
    // A body below the face, and one above it that has its tip on it.
    Mesh mesh = placed(joined(tetrahedron({}, {}, {}, {}), tetrahedron({}, {}, {}, {})));
    const Vec3d corners[8] = {a,
                              b,
                              c,
                              tip - outward,
                              tip,
                              tip + outward + point(4e5),
                              tip + outward + point(4e5),
                              tip + outward + point(4e5)};
    for (std::size_t v = 0; v < 8; ++v) mesh.positions[v] = static_cast<Vec3f>(corners[v]);
    const int axis = std::fabs(normal.x) > std::fabs(normal.y) ? (std::fabs(normal.x) > std::fabs(normal.z) ? 0 : 2)
                                                               : (std::fabs(normal.y) > std::fabs(normal.z) ? 1 : 2);
    const float step = normal[axis] > 0 ? 1.0F : -1.0F;
    CAPTURE(round);
    for (const auto& engine : engines) {
      CHECK(n_pairs(*engine, mesh) == 3);
      Mesh off = mesh;
      off.positions[4][axis] += step;
      CHECK(n_pairs(*engine, off) == 0);
      off.positions[4][axis] -= 2 * step;
      CHECK(n_pairs(*engine, off) == 3);
    }
  }
}

TEST_CASE("corners at one position with different indices touch") {
  const LatticeMesh mesh = joined(tetrahedron({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}),
                                  tetrahedron({0, 0, 0}, {-4, 0, 0}, {0, -4, 0}, {0, 0, -4}));
  for (const auto& engine : back_ends()) {
    CHECK(n_pairs(*engine, placed(mesh)) == 9);
    check_against_oracle(*engine, mesh);
  }
}

TEST_CASE("triangles that share an edge intersect when folded flat onto each other") {
  for (const auto& engine : back_ends()) {
    // All four corners in a plane: the four sides of the square are folds, its diagonals are not.
    CHECK(n_pairs(*engine, placed(tetrahedron({0, 0, 0}, {5, 0, 3}, {5, 5, 3}, {0, 5, 0}))) == 4);
    CHECK(n_pairs(*engine, placed(tetrahedron({0, 0, 0}, {5, 0, 3}, {5, 5, 3}, {0, 5, 1}))) == 0);
  }
}

TEST_CASE("a triangle without area is a pair with itself and in no other") {
  for (const auto& engine : back_ends()) {
    // Three corners on a line: the other three triangles lie in a plane, two of them on the third.
    const Mesh line = placed(tetrahedron({0, 0, 0}, {1, 2, 3}, {3, 6, 9}, {7, 1, 0}));
    const IntersectionReport report = engine->self_intersections(engine->upload_mesh(line));
    CHECK(report.n_degenerate == 1);
    CHECK(report.n_pairs == 3);
    const Mesh point = placed(tetrahedron({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}));
    CHECK(engine->self_intersections(engine->upload_mesh(point)).n_degenerate == 4);
    CHECK(n_pairs(*engine, joined(point, placed(tetrahedron({0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9})))) == 4);
    for (const float missing : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      Mesh mesh = icosphere(1, 3.0);
      mesh.positions[0].y = missing;  // of five triangles
      CHECK(engine->self_intersections(engine->upload_mesh(mesh)).n_degenerate == 5);
      CHECK(n_pairs(*engine, mesh) == 5);
    }
  }
}

TEST_CASE("faces in one plane, overlapping, touching along an edge, or apart, are decided as in integers") {
  const LatticeMesh base = tetrahedron({0, 0, 0}, {0, 8, 0}, {8, 0, 0}, {2, 2, 8});
  for (const auto& engine : back_ends()) {
    for (const LatticePoint shift :
         {LatticePoint{0, 0, 0}, {1, 1, 0}, {2, -1, 0}, {4, 4, 0}, {8, 0, 0}, {5, 4, 0}, {9, 0, 0}}) {
      LatticeMesh below = tetrahedron({0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {2, 2, -8});
      for (LatticePoint& p : below.points) p = p + shift;
      check_against_oracle(*engine, joined(base, below));
    }
  }
}

TEST_CASE("random closed meshes on a lattice, at any scale and place, are counted as in integers") {
  Random random(300);
  const auto engines = back_ends();
  std::size_t pairs = 0, degenerate = 0;
  for (int round = 0; round < 60; ++round) {
    const std::int64_t half_side = round % 3 == 0 ? 2 : round % 3 == 1 ? 8 : 500;
    const LatticeMesh soup = random_lattice_soup(random, 1 + round % 7, half_side);
    const OracleReport expected = intersections_oracle(soup);
    pairs += expected.n_pairs;
    degenerate += expected.n_degenerate;
    CAPTURE(round);
    for (const auto& engine : engines) {
      for (const double unit : {1.0, std::ldexp(1.0, -100), std::ldexp(1.0, 100)})
        check_against_oracle(*engine, soup, placed(soup, unit), expected);
      // Far out, where coordinates use all bits of a float.
      check_against_oracle(*engine, soup, placed(soup, 1.0, {(1 << 23) - 4000, 1 << 22, -(1 << 23) + 2000}), expected);
    }
  }
  std::printf("random lattice soups: %zu pairs, %zu of triangles without area\n", pairs, degenerate);
  CHECK(degenerate > 20);
  CHECK(pairs > 1000);
}

TEST_CASE("two spheres through one another, a pierced and a crumpled one are counted as in integers") {
  Random random(301);
  const Mesh crossed = joined(icosphere(2, 7.0), icosphere(2, 6.0, {5.3, 4.1, 2.2}));
  const Mesh crumpled = moved(icosphere(2, 7.0), [&](Vec3d p) { return p + random.in_box(2.0); });
  for (const auto& engine : back_ends()) {
    for (const Mesh& mesh : {crossed, pierced_sphere(), crumpled}) {
      const LatticeMesh lattice = snapped(mesh, 64);
      const OracleReport expected = intersections_oracle(lattice);
      CHECK(expected.n_pairs > 5);
      check_against_oracle(*engine, lattice, placed(lattice, 1.0 / 64), expected);
    }
  }
}

TEST_CASE("a rigid motion changes nothing if the surfaces clearly intersect or are clearly apart") {
  Random random(302);
  for (const auto& engine : back_ends()) {
    for (int round = 0; round < 10; ++round) {
      const espdiff::RigidTransform motion = random_rigid(random, 30);
      const auto after = [&](const Mesh& mesh) {
        return n_pairs(*engine, moved(mesh, [&](Vec3d p) { return motion.apply(p); }));
      };
      CHECK(after(placed(poking_tetrahedra(20), 1.0 / 16)) == 3);
      CHECK(after(placed(poking_tetrahedra(-20), 1.0 / 16)) == 0);
      CHECK(after(icosphere(3, 5.0)) == 0);
      CHECK(after(joined(icosphere(3, 5.0), icosphere(3, 5.0, {10.5, 1, 2}))) == 0);
    }
  }
}

TEST_CASE("the same pairs and triangles for 1, 2 and 4 threads") {
  Random random(303);
  const Mesh crumpled = moved(icosphere(4, 7.0), [&](Vec3d p) { return p + random.in_box(0.6); });
  const Mesh mesh = joined(joined(crumpled, icosphere(4, 6.0, {5.3, 4.1, 2.2})), pierced_sphere());
  const auto count = [&](Engine& engine) {
    const IntersectionReport report = engine.self_intersections(engine.upload_mesh(mesh));
    return std::pair(report.n_pairs, engine.download(report.intersecting));
  };
  const auto expected = count(*espdiff::select_engine(espdiff::DeviceChoice::kCpu, 1));
  CHECK(expected.first > 1000);
  for (const int n_threads : {2, 4})
    CHECK(count(*espdiff::select_engine(espdiff::DeviceChoice::kCpu, n_threads)) == expected);
  for (const auto& engine : back_ends()) CHECK(count(*engine) == expected);
}

TEST_CASE("surfaces of real proteins from the lattice do not intersect themselves") {
  for (const char* name : {"ubq/ubq.pqr", "pair_tim_maps/dTIM_chainA.pqr", "traj_adk/adk_open.pqr"}) {
    const auto path = real_input(name);
    if (!path) return;
    const AtomSet atoms = read_atoms(*path);
    for (const auto& engine : back_ends()) {
      const auto surface = engine->isosurface(engine->density(upload(*engine, atoms), 1.0), 0.5F);
      CHECK(engine->self_intersections(surface).n_pairs == 0);
    }
  }
}

TEST_SUITE_END();
