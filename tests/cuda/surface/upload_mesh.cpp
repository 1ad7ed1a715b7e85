// upload_mesh.cpp: uploaded meshes: accepted unchanged if closed, otherwise refused with the fault.
#include <doctest/doctest.h>

#include "base/error.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "engine/deform_stage.h"
#include "engine/engine.h"
#include "engine/surface_stage.h"
#include "support/test_data.h"

using namespace espdiff_test;

TEST_SUITE_BEGIN("upload_mesh");

TEST_CASE("an icosphere comes back as it was sent") {
  const Mesh sphere = icosphere(3, 5.0, {1, 2, 3});
  REQUIRE(manifold_fault(sphere) == "");
  for (const auto& engine : back_ends()) {
    const auto uploaded = engine->upload_mesh(sphere);
    const Mesh mesh = engine->download(uploaded);
    CHECK(mesh.positions == sphere.positions);
    CHECK(mesh.triangles == sphere.triangles);
    CHECK(mesh.component == std::vector<std::uint32_t>(sphere.positions.size(), 0));
    CHECK(engine->n_vertices(uploaded) == 642);
    CHECK(engine->n_triangles(uploaded) == 1280);
    CHECK(engine->area(uploaded) == doctest::Approx(area_oracle(sphere)).epsilon(1e-6));
    REQUIRE(mesh.normals.size() == sphere.positions.size());
    double worst = 0;
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
      const Vec3d outward = 0.2 * (static_cast<Vec3d>(mesh.positions[v]) - Vec3d{1, 2, 3});
      worst = std::max(worst, norm(static_cast<Vec3d>(mesh.normals[v]) - outward));
    }
    CHECK(worst < 0.015);  // the triangles around a vertex differ in size
    const auto components = engine->components(uploaded);
    REQUIRE(components.size() == 1);
    CHECK(components[0].volume_A3 == doctest::Approx(signed_volume(sphere)).epsilon(1e-9));
    CHECK(engine->components(engine->upload_mesh(turned(sphere)))[0].volume_A3 ==
          doctest::Approx(-components[0].volume_A3).epsilon(1e-9));
  }
}

TEST_CASE("the areas of a tetrahedron and of a sliver are exact") {
  for (const auto& engine : back_ends()) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {0, 0, 1e-3F}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    CHECK(engine->area(engine->upload_mesh(mesh)) == doctest::Approx(area_oracle(mesh)).epsilon(1e-6));
  }
}

TEST_CASE("displacement is the distance of vertices of one index") {
  const Mesh sphere = icosphere(2, 3.0);
  const Mesh shifted = moved(sphere, [](Vec3d p) { return Vec3d{p.x + 3, p.y - 4, p.z * 2}; });
  for (const auto& engine : back_ends()) {
    const auto d = engine->download(engine->displacement(engine->upload_mesh(sphere), engine->upload_mesh(shifted)));
    REQUIRE(d.size() == sphere.positions.size());
    double worst = 0;
    for (std::size_t v = 0; v < d.size(); ++v) {
      const double exact = norm(static_cast<Vec3d>(shifted.positions[v]) - static_cast<Vec3d>(sphere.positions[v]));
      worst = std::max(worst, std::fabs(static_cast<double>(d[v]) - exact));
    }
    CHECK(worst < 1e-6);
    CHECK_THROWS_AS(engine->displacement(engine->upload_mesh(sphere), engine->upload_mesh(icosphere(1, 3))),
                    espdiff::InputError);
  }
}

TEST_CASE("meshes that are not closed or not consistent are refused, and the edge named") {
  const Mesh sphere = icosphere(0, 1.0);
  Mesh open = sphere;
  open.triangles.erase(open.triangles.begin());  // 0 11 5: leaves 5 -> 11, 11 -> 0, 0 -> 5 without opposites
  Mesh flipped = sphere;
  std::swap(flipped.triangles[0][1], flipped.triangles[0][2]);
  Mesh doubled = sphere;
  doubled.triangles.push_back(doubled.triangles[0]);
  Mesh out_of_range = sphere;
  out_of_range.triangles[4][1] = 12;
  for (const auto& engine : back_ends()) {
    const auto message = [&](const Mesh& mesh) { return message_of([&] { engine->upload_mesh(mesh); }); };
    for (const Mesh* mesh : {&open, &flipped, &doubled, &out_of_range}) {
      CHECK_THROWS_AS(engine->upload_mesh(*mesh), espdiff::GeometryError);
    }
    CHECK(message(open) ==
          "the mesh is not closed or not consistently oriented: edge 0 - 5 does not lie in exactly two triangles");
    CHECK(message(flipped) ==
          "the mesh is not closed or not consistently oriented: edge 0 - 5 does not lie in exactly two triangles");
    CHECK(message(doubled) ==
          "the mesh is not closed or not consistently oriented: edge 0 - 11 does not lie in exactly two triangles");
    CHECK(message(out_of_range) == "a triangle names vertex 12, which does not exist");
  }
}

TEST_CASE("a triangle that names one vertex twice is refused") {
  // 0 0 12 balances itself: 0 -> 0 is its own opposite, 0 -> 12 and 12 -> 0 are each other's.
  Mesh mesh = icosphere(0, 1.0);
  mesh.positions.push_back({2, 0, 0});
  mesh.triangles.push_back({0, 0, 12});
  for (const auto& engine : back_ends()) CHECK_THROWS_AS(engine->upload_mesh(mesh), espdiff::GeometryError);
}

TEST_CASE("a vertex in no triangle does not move under deform") {
  Mesh mesh = icosphere(1, 2.0);
  mesh.positions.push_back({7, 8, 9});
  for (const auto& engine : back_ends()) {
    espdiff::MeshPtr uploaded;
    try {
      uploaded = engine->upload_mesh(mesh);
    } catch (const espdiff::GeometryError&) {
      continue;  // refusing it is also correct
    }
    const auto density = engine->density(upload(*engine, one_gaussian({0, 0, 0}, 2)), 1.0);
    espdiff::DeformOptions options;
    options.mu = 0;
    options.max_iterations = 5;
    const Mesh after = engine->download(
        engine->deform(uploaded, engine->density_field(density, 0.5F), options, "deform", {}, nullptr));
    CHECK(norm(after.positions.back() - mesh.positions.back()) < 1e-6F);
  }
}

TEST_CASE("a mesh with its vertices elsewhere has the same topology") {
  for (const auto& engine : back_ends()) {
    Mesh mesh = icosphere(1, 5.0, {0, 0, 0});
    const espdiff::MeshPtr first = engine->upload_mesh(mesh);
    for (Vec3f& p : mesh.positions) p = 2.0F * p;
    const espdiff::MeshPtr moved = engine->with_positions(first, mesh.positions);
    CHECK(engine->area(moved) == doctest::Approx(4 * engine->area(first)));
    CHECK(engine->download(moved).triangles == mesh.triangles);
    mesh.positions.pop_back();
    CHECK(message_of([&] { engine->with_positions(first, mesh.positions); }) ==
          "41 positions for a mesh of 42 vertices");
  }
}

TEST_SUITE_END();
