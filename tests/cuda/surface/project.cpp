// project.cpp: Newton's method onto the analytic isosurface.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "cuda/surface/read_atoms.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;

namespace {

struct Projection {
  double worst_density_error = 0;  ///< of the vertices that moved
  double longest_shift = 0;
  double left_share = 0;  ///< fraction of vertices left in place off the isosurface
};

Projection measure(Engine& engine, const AtomSet& atoms, float isovalue, double spacing, double max_shift) {
  const auto uploaded = upload(engine, atoms);
  const auto surface = engine.isosurface(engine.density(uploaded, spacing), isovalue);
  const Mesh before = engine.download(surface),
             after = engine.download(engine.project(surface, uploaded, isovalue, max_shift));
  CHECK(after.triangles == before.triangles);
  const std::vector<float> density = engine.density_at(uploaded, after.positions);
  Projection result;
  for (std::size_t v = 0; v < before.positions.size(); ++v) {
    const double error = std::fabs(static_cast<double>(density[v]) - static_cast<double>(isovalue));
    const double shift = norm(static_cast<Vec3d>(after.positions[v]) - static_cast<Vec3d>(before.positions[v]));
    result.longest_shift = std::max(result.longest_shift, shift);
    if (shift > 0) {
      result.worst_density_error = std::max(result.worst_density_error, error);
    } else if (error > 1e-4) {
      result.left_share += 1.0 / static_cast<double>(before.positions.size());
    }
  }
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("project");

TEST_CASE("vertices land on the isosurface to 1e-4 or stay") {
  for (const auto& engine : back_ends()) {
    for (std::uint64_t seed = 50; seed < 54; ++seed) {
      const Projection p = measure(*engine, random_cloud(250, seed), 0.5F, 1.0, 0.5);
      CAPTURE(seed);
      CHECK(p.worst_density_error < 1e-4);
      CHECK(p.longest_shift <= 0.5);
      CHECK(p.left_share < 0.01);
    }
  }
}

TEST_CASE("vertices of a real surface land on the isosurface to 1e-4 or stay") {
  for (const std::string name : {"ubq/ubq.pqr", "pair_tim_maps/scTIM_chainA.pqr"}) {
    const auto path = real_input(name);
    if (!path) return;
    for (const auto& engine : back_ends()) {
      const Projection p = measure(*engine, read_atoms(*path), 0.5F, 1.0, 0.5);
      std::printf("project, %s, %s: worst density error %.2e, longest shift %.3f A, left where they were %.3f %%\n",
                  engine->back_end().c_str(), name.c_str(), p.worst_density_error, p.longest_shift, 100 * p.left_share);
      CAPTURE(name);
      CHECK(p.worst_density_error < 1e-4);
      CHECK(p.longest_shift <= 0.5);
      CHECK(p.left_share < 0.01);
    }
  }
}

TEST_CASE("vertices land on the isosurface to 1e-4 at low and high isovalues too") {
  for (const auto& engine : back_ends()) {
    for (const float isovalue : {0.05F, 0.2F, 0.8F}) {
      CAPTURE(isovalue);
      CHECK(measure(*engine, one_gaussian({0.1, 0.2, 0.3}, 1.7), isovalue, 0.5, 0.25).worst_density_error < 1e-4);
    }
  }
}

TEST_CASE("a vertex farther off than the limit stays where it is") {
  for (const auto& engine : back_ends()) {
    const double r = 2.0 * std::sqrt(2 * std::log(2.0));
    const auto atoms = upload(*engine, one_gaussian({0, 0, 0}, 2.0));
    for (const double factor : {0.7, 1.4, 3.0, 10.0}) {  // the last two partly or fully beyond the Gaussian's reach
      const Mesh sphere = icosphere(2, factor * r);
      const Mesh after = engine->download(engine->project(engine->upload_mesh(sphere), atoms, 0.5F, 0.3));
      CAPTURE(factor);
      CHECK(after.positions == sphere.positions);
    }
    const Mesh near = engine->download(engine->project(engine->upload_mesh(icosphere(2, 1.2 * r)), atoms, 0.5F, 0.8));
    double worst = 0;
    for (const Vec3f& p : near.positions) worst = std::max(worst, std::fabs(static_cast<double>(norm(p)) - r));
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("projecting twice moves nothing more") {
  for (const auto& engine : back_ends()) {
    const auto atoms = upload(*engine, random_cloud(200, 55));
    const auto once = engine->project(engine->isosurface(engine->density(atoms, 1.0), 0.5F), atoms, 0.5F, 0.5);
    const auto twice = engine->project(once, atoms, 0.5F, 0.5);
    std::vector<float> shift = engine->download(engine->displacement(once, twice));
    std::sort(shift.begin(), shift.end());
    CHECK(shift[shift.size() * 99 / 100] < 2e-4F);  // all but those that stayed off the surface the first time
  }
}

TEST_SUITE_END();
