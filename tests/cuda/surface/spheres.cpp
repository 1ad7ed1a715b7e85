// spheres.cpp: surfaces known exactly: one Gaussian is a sphere, two merge at a known distance.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/surface_stage.h"
#include "support/random.h"

using namespace espdiff_test;

namespace {

/// exp(-r^2 / (2 s^2)) = isovalue.
double sphere_radius(double width, double isovalue) { return width * std::sqrt(-2 * std::log(isovalue)); }

struct Errors {
  double area, volume;  // relative
};

Errors sphere_errors(Engine& engine, double width, float isovalue, double spacing) {
  // Off the lattice's symmetry, for a generic error.
  const auto atoms = upload(engine, one_gaussian({0.137, -0.291, 0.418}, width));
  const auto mesh = engine.isosurface(engine.density(atoms, spacing), isovalue);
  const double r = sphere_radius(width, static_cast<double>(isovalue));
  return {engine.area(mesh) / (4 * kPi * r * r) - 1,
          signed_volume(engine.download(mesh)) / (4 * kPi / 3 * r * r * r) - 1};
}

}  // namespace

TEST_SUITE_BEGIN("sphere");

TEST_CASE("one Gaussian gives a sphere: projected vertices lie on it") {
  for (const auto& engine : back_ends()) {
    CAPTURE(engine->back_end());
    for (const double width : {0.8, 1.2, 1.7, 2.3}) {
      for (const float isovalue : {0.2F, 0.5F, 0.8F}) {
        const Vec3d centre{1.3, -2.1, 0.6};
        const auto atoms = upload(*engine, one_gaussian(centre, width));
        const auto surface = engine->isosurface(engine->density(atoms, 0.5), isovalue);
        const Mesh mesh = engine->download(engine->project(surface, atoms, isovalue, 0.25));
        const double r = sphere_radius(width, static_cast<double>(isovalue));
        double worst = 0;
        for (const Vec3f& p : mesh.positions)
          worst = std::max(worst, std::fabs(norm(static_cast<Vec3d>(p) - centre) - r));
        CAPTURE(width);
        CAPTURE(isovalue);
        // The density converges to 1e-4; at other isovalues it is flatter, which leaves a larger position error.
        CHECK(worst < (isovalue == 0.5F ? 1e-4 : 1.5e-3));
        CHECK(manifold_fault(mesh) == "");
        CHECK(euler_characteristic(mesh) == 2);
      }
    }
  }
}

TEST_CASE("area and volume of the sphere converge with second order in the spacing") {
  for (const auto& engine : back_ends()) {
    CAPTURE(engine->back_end());
    const Errors coarse = sphere_errors(*engine, 2.0, 0.5F, 0.5), fine = sphere_errors(*engine, 2.0, 0.5F, 0.125);
    const double area_order = std::log2(std::fabs(coarse.area / fine.area)) / 2;
    const double volume_order = std::log2(std::fabs(coarse.volume / fine.volume)) / 2;
    std::printf("sphere, %s: area off by %.2e and %.2e, order %.2f; volume %.2e and %.2e, order %.2f\n",
                engine->back_end().c_str(), coarse.area, fine.area, area_order, coarse.volume, fine.volume,
                volume_order);
    CHECK(area_order == doctest::Approx(2).epsilon(0.1));
    CHECK(volume_order == doctest::Approx(2).epsilon(0.1));
    CHECK(std::fabs(fine.area) < 2e-3);
    CHECK(std::fabs(fine.volume) < 2e-3);
  }
}

TEST_CASE("two Gaussians merge where the density between them passes the isovalue") {
  for (const auto& engine : back_ends()) {
    CAPTURE(engine->back_end());
    for (const double width : {1.0, 1.6}) {
      // On the middle, 2 exp(-d^2 / (8 s^2)) = isovalue.
      const double merging = width * std::sqrt(8 * std::log(2 / 0.5));
      for (const double factor : {0.8, 0.98, 1.02, 1.3}) {
        AtomSet atoms = one_gaussian({0.05, 0.02, 0.01}, width);
        atoms.add({0.05 + factor * merging, 0.02, 0.01}, width);
        const auto mesh = engine->isosurface(engine->density(upload(*engine, atoms), 0.1 * width), 0.5F);
        CAPTURE(factor);
        const auto components = engine->components(mesh);
        CHECK(components.size() == (factor < 1 ? 1 : 2));
        for (const auto& component : components) {
          CHECK(component.volume_A3 > 0);
          CHECK(static_cast<int>(component.n_vertices) - static_cast<int>(component.n_triangles / 2) == 2);
        }
      }
    }
  }
}

TEST_CASE("two distant spheres of one size each have the area and volume of one sphere") {
  for (const auto& engine : back_ends()) {
    AtomSet atoms = one_gaussian({0, 0, 0}, 1.5);
    atoms.add({20, 0, 0}, 1.5);  // 40 lattice steps, so both have the same position in their cells
    const auto components = engine->components(engine->isosurface(engine->density(upload(*engine, atoms), 0.5), 0.5F));
    REQUIRE(components.size() == 2);
    const double r = sphere_radius(1.5, 0.5);
    for (const auto& component : components) {
      // A spacing of r / 3.5: the chords of a sphere this coarse cut off up to 6 % of the volume.
      CHECK(component.area_A2 == doctest::Approx(4 * kPi * r * r).epsilon(0.03));
      CHECK(component.volume_A3 == doctest::Approx(4 * kPi / 3 * r * r * r).epsilon(0.06));
    }
    CHECK(components[0].volume_A3 == doctest::Approx(components[1].volume_A3).epsilon(1e-5));
  }
}

TEST_SUITE_END();
