// level_set_curvature.cpp: mean curvature of spheres, cylinders and clouds of atoms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "engine/engine.h"

using namespace espdiff_test;
using espdiff::AtomsPtr;
using espdiff::MeshPtr;

namespace {

MeshPtr on_level_set(Engine& engine, const AtomsPtr& atoms) {
  return engine.project(engine.isosurface(engine.density(atoms, 1.0), kIsovalue), atoms, kIsovalue, 0.5);
}

/// The outward unit normal of the untruncated density.
Vec3d outward(const AtomSet& atoms, Vec3d p) {
  Vec3d slope{};
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const double s = static_cast<double>(atoms.widths[i]);
    const Vec3d d = p - atoms.positions[i];
    slope += (std::exp(-dot(d, d) / (2 * s * s)) / (s * s)) * d;
  }
  return (1 / norm(slope)) * slope;
}

/// Half the divergence of the normal, by central differences.
double curvature_by_differences(const AtomSet& atoms, Vec3d p) {
  constexpr double kStep = 1e-4;
  double divergence = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d step{};
    step[axis] = kStep;
    divergence += (outward(atoms, p + step)[axis] - outward(atoms, p - step)[axis]) / (2 * kStep);
  }
  return divergence / 2;
}

}  // namespace

TEST_SUITE_BEGIN("level_set_curvature");

TEST_CASE("a sphere has the curvature 1/r") {
  for (const auto& engine : back_ends()) {
    for (const double width : {1.0, 2.0}) {
      const AtomSet atom = one_gaussian({0.3, -0.2, 0.1}, width);
      const AtomsPtr atoms = upload(*engine, atom);
      const MeshPtr surface = on_level_set(*engine, atoms);
      const double radius = width * std::sqrt(2 * std::log(1 / static_cast<double>(kIsovalue)));
      for (const float curvature : engine->level_set_curvature(surface, atoms, kIsovalue))
        REQUIRE(static_cast<double>(curvature) == doctest::Approx(1 / radius).epsilon(1e-4));
    }
  }
}

TEST_CASE("a row of atoms is a cylinder of curvature 1/(2r), and a groove between two rows is negative") {
  AtomSet row, groove;
  for (int i = -40; i <= 40; ++i) {
    row.add({0.25 * i, 0, 0}, 1.5);
    for (const double y : {-2.4, 2.4}) groove.add({0.25 * i, y, 0}, 1.5);
  }
  for (const auto& engine : back_ends()) {
    const AtomsPtr atoms = upload(*engine, row);
    const MeshPtr surface = on_level_set(*engine, atoms);
    const std::vector<Vec3f> points = engine->download_positions(surface);
    const std::vector<float> curvature = engine->level_set_curvature(surface, atoms, kIsovalue);
    std::size_t n = 0;
    for (std::size_t v = 0; v < points.size(); ++v) {
      if (std::fabs(points[v].x) > 3) continue;
      const double radius = std::hypot(static_cast<double>(points[v].y), static_cast<double>(points[v].z));
      REQUIRE(static_cast<double>(curvature[v]) == doctest::Approx(1 / (2 * radius)).epsilon(2e-3));
      ++n;
    }
    CHECK(n > 50);
    const AtomsPtr two = upload(*engine, groove);
    const MeshPtr grooved = on_level_set(*engine, two);
    const std::vector<Vec3f> places = engine->download_positions(grooved);
    const std::vector<float> there = engine->level_set_curvature(grooved, two, kIsovalue);
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (std::fabs(places[v].x) < 3 && std::fabs(places[v].y) < 0.3F) REQUIRE(there[v] < 0);
    }
  }
}

TEST_CASE("curvatures of many atoms are half the divergence of the normal") {
  const AtomSet cloud = random_cloud(250, 60);
  for (const auto& engine : back_ends()) {
    const AtomsPtr atoms = upload(*engine, cloud);
    const MeshPtr surface = on_level_set(*engine, atoms);
    const std::vector<Vec3f> points = engine->download_positions(surface);
    const std::vector<float> curvature = engine->level_set_curvature(surface, atoms, kIsovalue);
    double sum = 0;
    std::size_t n = 0;
    for (std::size_t v = 0; v < points.size(); v += 5) {
      if (!std::isfinite(curvature[v])) continue;
      const double exact = curvature_by_differences(cloud, static_cast<Vec3d>(points[v]));
      if (std::fabs(exact) > 1) continue;  // near a point without gradient every error counts
      sum += std::fabs(static_cast<double>(curvature[v]) - exact);
      CHECK(static_cast<double>(curvature[v]) == doctest::Approx(exact).epsilon(0.05));
      ++n;
    }
    CHECK(n > 200);
    CHECK(sum / static_cast<double>(n) < 2e-3);
  }
}

TEST_CASE("off the surface there is no curvature") {
  for (const auto& engine : back_ends()) {
    const AtomsPtr atoms = upload(*engine, one_gaussian({}, 2.0));
    const MeshPtr away = engine->upload_mesh(icosphere(1, 4.0));
    for (const float curvature : engine->level_set_curvature(away, atoms, kIsovalue)) REQUIRE(std::isnan(curvature));
  }
}

TEST_SUITE_END();
