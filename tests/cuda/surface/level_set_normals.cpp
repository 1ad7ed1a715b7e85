// level_set_normals.cpp: the analytic normals against a sphere's, against finite differences of the density, and off
// the surface.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "engine/engine.h"

using namespace espdiff_test;
using espdiff::AtomsPtr;
using espdiff::MeshPtr;

namespace {

/// A mesh whose vertices lie on the analytic surface.
MeshPtr projected(Engine& engine, const AtomsPtr& atoms) {
  return engine.project(engine.isosurface(engine.density(atoms, 1.0), kIsovalue), atoms, kIsovalue, 0.5);
}

double cosine(Vec3f a, Vec3f b) { return static_cast<double>(dot(a, b)); }

}  // namespace

TEST_SUITE_BEGIN("level_set_normals");

TEST_CASE("one atom: normals point away from its centre, more exactly than the triangles'") {
  for (const auto& engine : back_ends()) {
    AtomSet atom;
    atom.positions = {{0.3, -0.2, 0.1}};
    atom.widths = {2.0F};
    atom.residues = {0};
    const AtomsPtr atoms = upload(*engine, atom);
    const MeshPtr surface = projected(*engine, atoms);
    const Mesh mesh = engine->download(surface);
    const std::vector<Vec3f> normals = engine->level_set_normals(surface, atoms, kIsovalue);
    REQUIRE(normals.size() == mesh.positions.size());
    double least = 1, least_of_triangles = 1;
    for (std::size_t v = 0; v < normals.size(); ++v) {
      const Vec3d away = static_cast<Vec3d>(mesh.positions[v]) - atom.positions[0];
      const Vec3f radial = static_cast<Vec3f>((1 / norm(away)) * away);
      least = std::min(least, cosine(normals[v], radial));
      least_of_triangles = std::min(least_of_triangles, cosine(mesh.normals[v], radial));
    }
    CHECK(least > 1 - 1e-6);
    CHECK(least_of_triangles < 1 - 1e-4);
  }
}

TEST_CASE("many atoms: normals are unit, on the triangles' side, and along the density's differences") {
  for (const auto& engine : back_ends()) {
    const AtomsPtr atoms = upload(*engine, random_cloud(250, 60));
    const MeshPtr surface = projected(*engine, atoms);
    const Mesh mesh = engine->download(surface);
    const std::vector<Vec3f> normals = engine->level_set_normals(surface, atoms, kIsovalue);
    constexpr float kStep = 0.01F;
    std::vector<Vec3f> around;
    for (const Vec3f& p : mesh.positions) {
      for (const Vec3f step : {Vec3f{kStep, 0, 0}, Vec3f{0, kStep, 0}, Vec3f{0, 0, kStep}}) {
        around.push_back(p + step);
        around.push_back(p - step);
      }
    }
    const std::vector<float> density = engine->density_at(atoms, around);
    double worst_length = 0, least_side = 1, least_along = 1;
    for (std::size_t v = 0; v < normals.size(); ++v) {
      const float* const d = &density[6 * v];
      const Vec3d falling{static_cast<double>(d[1] - d[0]), static_cast<double>(d[3] - d[2]),
                          static_cast<double>(d[5] - d[4])};
      worst_length = std::max(worst_length, std::fabs(static_cast<double>(norm(normals[v])) - 1));
      least_side = std::min(least_side, cosine(normals[v], mesh.normals[v]));
      // Where the level set has no direction, neither do the differences.
      if (norm(falling) > 0.02 * static_cast<double>(kStep))
        least_along = std::min(least_along, dot(static_cast<Vec3d>(normals[v]), falling) / norm(falling));
    }
    CHECK(worst_length < 1e-6);
    CHECK(least_side > 0);
    CHECK(least_along > 0.999);
  }
}

TEST_CASE("a mesh off the surface keeps its triangles' normals") {
  for (const auto& engine : back_ends()) {
    const AtomsPtr atoms = upload(*engine, random_cloud(50, 61));
    const MeshPtr surface = projected(*engine, atoms);
    std::vector<Vec3f> moved = engine->download(surface).positions;
    for (Vec3f& p : moved) p += Vec3f{40, 0, 0};
    const MeshPtr away = engine->with_positions(surface, moved);
    const std::vector<Vec3f> normals = engine->level_set_normals(away, atoms, kIsovalue);
    const std::vector<Vec3f> of_triangles = engine->download(away).normals;
    for (std::size_t v = 0; v < normals.size(); ++v) REQUIRE(norm(normals[v] - of_triangles[v]) == 0.0F);
  }
}

TEST_SUITE_END();
