// intersections_cgal.cpp: pairs of intersecting triangles against CGAL's, on deformed proteins and on planted cases.
#include <doctest/doctest.h>

#include "cuda/certificate/intersection_oracle.h"
#include "cuda/surface/read_atoms.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "support/test_data.h"

#if defined(ESPDIFF_HAVE_CGAL)

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <chrono>
#include <cstdio>

#include "cuda/certificate/cgal_mesh.h"

using namespace espdiff_test;

namespace {

/// Same number of pairs and the same triangles in them; returns the number.
std::size_t check_against_cgal(Engine& engine, const espdiff::MeshPtr& surface, const std::string& what) {
  const Mesh mesh = engine.download(surface);
  const CgalMesh theirs = cgal_mesh(mesh);
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(theirs, std::back_inserter(pairs));
  const auto middle = std::chrono::steady_clock::now();
  const espdiff::IntersectionReport report = engine.self_intersections(surface);
  const auto end = std::chrono::steady_clock::now();

  std::vector<float> expected(mesh.triangles.size(), 0.0F);
  for (const auto& [a, b] : pairs) expected[a.idx()] = expected[b.idx()] = 1;
  CHECK(report.n_pairs == pairs.size());
  CHECK(engine.download(report.intersecting) == expected);
  if (!what.empty()) {
    using Milliseconds = std::chrono::duration<double, std::milli>;
    std::printf("%s, %s: %zu triangles, %zu pairs, CGAL %zu; %.1f ms, CGAL %.1f ms on one thread\n", what.c_str(),
                engine.description().c_str(), mesh.triangles.size(), report.n_pairs, pairs.size(),
                Milliseconds(end - middle).count(), Milliseconds(middle - start).count());
  }
  return pairs.size();
}

std::size_t check_against_cgal(Engine& engine, const Mesh& mesh) {
  return check_against_cgal(engine, engine.upload_mesh(mesh), "");
}

/// A surface between two shapes.
espdiff::MeshPtr deformed(Engine& engine, const AtomSet& source_atoms, const AtomSet& target_atoms, int iterations) {
  const auto source = upload(engine, source_atoms), target = upload(engine, target_atoms);
  const auto start = engine.project(engine.isosurface(engine.density(source, 1.0), 0.5F), source, 0.5F, 0.5);
  const auto density = engine.density(target, 1.0);
  const auto field = engine.distance_field(density, 0.5F, engine.isosurface(density, 0.5F), 0.75, {});
  espdiff::DeformOptions options;
  options.max_iterations = iterations;
  return engine.deform(start, field, options, "deform", {}, nullptr);
}

}  // namespace

TEST_SUITE_BEGIN("intersections");

TEST_CASE("deformed proteins have the intersecting pairs that CGAL finds") {
  for (const auto& [from, to] : {std::pair("series19_ubq_2k39/m00.pqr", "series19_ubq_2k39/m18.pqr"),
                                 {"series19_ubq_2k39/m05.pqr", "series19_ubq_2k39/m11.pqr"},
                                 {"pair_tim_maps/dTIM_chainA.pqr", "pair_tim_maps/scTIM_chainA.pqr"}}) {
    const auto source = real_input(from), target = real_input(to);
    if (!source || !target) return;
    const AtomSet source_atoms = read_atoms(*source), target_atoms = read_atoms(*target);
    for (const auto& engine : back_ends()) {
      for (const int iterations : {20, 300}) {
        const std::string what = std::string(from) + " onto " + to + ", " + std::to_string(iterations) + " iterations";
        check_against_cgal(*engine, deformed(*engine, source_atoms, target_atoms, iterations), what);
      }
    }
  }
}

TEST_CASE("planted intersections are those that CGAL finds") {
  Random random(310);
  const Mesh crossed = joined(icosphere(3, 7.0), icosphere(3, 6.0, {5.3, 4.1, 2.2}));
  for (const auto& engine : back_ends()) {
    CHECK(check_against_cgal(*engine, icosphere(3, 7.0)) == 0);
    CHECK(check_against_cgal(*engine, crossed) > 100);
    for (const double amount : {0.05, 0.3, 1.0, 4.0}) {
      const Mesh crumpled = moved(icosphere(3, 7.0), [&](Vec3d p) { return p + random.in_box(amount); });
      check_against_cgal(*engine, crumpled);
    }
  }
}

TEST_CASE("touching, flat and degenerate triangles are decided as CGAL does") {
  Random random(311);
  std::size_t pairs = 0;
  for (const auto& engine : back_ends()) {
    for (int round = 0; round < 100; ++round) {
      const std::int64_t half_side = round % 2 == 0 ? 2 : 6;
      pairs += check_against_cgal(*engine, placed(random_lattice_soup(random, 1 + round % 9, half_side)));
    }
  }
  CHECK(pairs > 1000);
}

TEST_CASE("coordinates of very different size, and nearly flat triangles, are decided as CGAL does") {
  Random random(312);
  for (const auto& engine : back_ends()) {
    for (int round = 0; round < 60; ++round) {
      Mesh mesh = placed(random_lattice_soup(random, 9, 3));
      for (Vec3f& p : mesh.positions) {
        for (int axis = 0; axis < 3; ++axis) {
          if (round % 2 == 0) {  // from 2^-60 to 2^60
            p[axis] = std::ldexp(p[axis], static_cast<int>(random.below(121)) - 60);
          } else if (random.below(2) == 0) {  // the next float
            p[axis] = std::nextafter(p[axis], random.below(2) == 0 ? 10.0F : -10.0F);
          }
        }
      }
      check_against_cgal(*engine, mesh);
    }
  }
}

TEST_SUITE_END();

#else

TEST_CASE("intersecting pairs are those that CGAL finds") {
  MESSAGE("SKIPPED: CGAL was not found when this was built (Debian: libcgal-dev)");
}

#endif
