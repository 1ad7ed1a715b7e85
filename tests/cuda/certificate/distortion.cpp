// distortion.cpp: area ratios and symmetric Dirichlet energy of linear maps, known in closed form, and submeshes.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/certificate_stage.h"
#include "engine/engine.h"
#include "support/random.h"

using namespace espdiff_test;
using espdiff::DistortionReport;

namespace {

DistortionReport report(Engine& engine, const Mesh& source, const Mesh& mapped) {
  const auto from = engine.upload_mesh(source);
  return engine.distortion(from, engine.with_positions(from, mapped.positions), 10);
}

}  // namespace

TEST_SUITE_BEGIN("distortion");

TEST_CASE("a rigid motion distorts nothing") {
  Random random(31);
  const Mesh mesh = icosphere(3, 6);
  const auto motion = random_rigid(random, 5);
  for (const auto& engine : back_ends()) {
    const DistortionReport d = report(*engine, mesh, moved(mesh, [&](Vec3d p) { return motion.apply(p); }));
    for (const double one :
         {d.area_ratio_p05, d.area_ratio_median, d.area_ratio_p95, d.dirichlet_median, d.dirichlet_p95})
      CHECK(one == doctest::Approx(1).epsilon(1e-4));
  }
}

TEST_CASE("a magnification by s has area ratio s^2 and energy (s^2 + 1/s^2) / 2") {
  const Mesh mesh = icosphere(3, 6);
  for (const auto& engine : back_ends()) {
    for (const double s : {0.5, 1.5, 3.0}) {
      const DistortionReport d = report(*engine, mesh, moved(mesh, [&](Vec3d p) { return s * p; }));
      CHECK(d.area_ratio_median == doctest::Approx(s * s).epsilon(1e-4));
      CHECK(d.dirichlet_p95 == doctest::Approx((s * s + 1 / (s * s)) / 2).epsilon(1e-4));
      CHECK(engine->download(d.excessive)[0] == 0);
    }
    const DistortionReport d = report(*engine, mesh, moved(mesh, [](Vec3d p) { return 4.0 * p; }));
    for (const float flag : engine->download(d.excessive)) CHECK(flag == 1);
  }
}

TEST_CASE("a stretch of a flat face along one edge") {
  Mesh mesh;  // a flat box: the two large faces are stretched, singular values 2 and 1
  mesh.positions = {{0, 0, 0},     {10, 0, 0},     {10, 10, 0},     {0, 10, 0},
                    {0, 0, 0.01F}, {10, 0, 0.01F}, {10, 10, 0.01F}, {0, 10, 0.01F}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                    {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  for (const auto& engine : back_ends()) {
    const DistortionReport d = report(*engine, mesh, moved(mesh, [](Vec3d p) { return Vec3d{2 * p.x, p.y, p.z}; }));
    CHECK(d.area_ratio_median == doctest::Approx(2).epsilon(1e-4));
    CHECK(d.dirichlet_median == doctest::Approx((4 + 1 + 0.25 + 1) / 4.0).epsilon(1e-4));
  }
}

TEST_CASE("meshes of different topology are refused") {
  for (const auto& engine : back_ends()) {
    CHECK_THROWS_WITH_AS(
        engine->distortion(engine->upload_mesh(icosphere(1, 1)), engine->upload_mesh(icosphere(2, 1)), 10),
        "distortion: the meshes differ in topology", espdiff::GeometryError);
  }
}

TEST_CASE("a submesh keeps the order, and only the vertices that it uses") {
  const Mesh mesh = icosphere(2, 4);
  for (const auto& engine : back_ends()) {
    std::vector<float> excluded;
    std::vector<espdiff::Triangle> kept;
    for (const auto& t : mesh.triangles) {
      const bool above = mesh.positions[t[0]].z > 0 && mesh.positions[t[1]].z > 0 && mesh.positions[t[2]].z > 0;
      excluded.push_back(above ? 0.0F : 1.0F);
      if (above) kept.push_back(t);
    }
    const auto whole = engine->upload_mesh(mesh);
    const Mesh part = engine->download(engine->without(whole, engine->upload_scalars(excluded)));
    REQUIRE(part.triangles.size() == kept.size());
    for (std::size_t t = 0; t < kept.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) CHECK(part.positions[part.triangles[t][c]] == mesh.positions[kept[t][c]]);
    for (const Vec3f p : part.positions) CHECK(p.z > 0);
    CHECK_THROWS_WITH_AS(engine->without(whole, engine->upload_scalars(std::vector<float>(mesh.triangles.size(), 1))),
                         "no triangle of the surface remains", espdiff::GeometryError);
  }
}

TEST_SUITE_END();
