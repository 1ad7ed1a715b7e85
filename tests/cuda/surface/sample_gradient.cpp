// sample_gradient.cpp: gradients of maps of charges, of affine functions and of computed potentials.
#include <doctest/doctest.h>

#include <cmath>

#include "cuda/potential/poisson_boltzmann_inputs.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;
using espdiff::GridPtr;
using espdiff::RigidTransform;

namespace {

constexpr double kCoulombAt300K = 332.0636 / (300 * 0.001987191);

/// The field at each vertex of a sphere about a charge of one, over the analytic C / (epsilon r^2).
void check_radial(Engine& engine, const GridPtr& map, Vec3d centre, double radius, double dielectric,
                  double tolerance) {
  const Mesh sphere = icosphere(2, radius, centre);
  const auto gradients = engine.sample_gradient(map, engine.upload_mesh(sphere));
  const double expected = kCoulombAt300K / (dielectric * radius * radius);
  for (std::size_t v = 0; v < gradients.size(); ++v) {
    const Vec3d outward = (1 / radius) * (static_cast<Vec3d>(sphere.positions[v]) - centre);
    REQUIRE(norm(static_cast<Vec3d>(gradients[v]) + expected * outward) < tolerance * expected);
  }
}

}  // namespace

TEST_SUITE_BEGIN("sample_gradient");

TEST_CASE("a charge in vacuum has the field C / r^2") {
  for (const auto& engine : back_ends()) {
    const Vec3d centre{1, 2, -3};
    const GridPtr map = engine->isolated_charges({centre}, {1.0F}, {}, {});
    for (const double radius : {1.5, 4.0, 20.0}) check_radial(*engine, map, centre, radius, 1, 1e-4);
  }
}

TEST_CASE("a Born ion has the field C / (80 r^2) outside its sphere") {
  for (const auto& engine : fast_back_ends()) {
    const Vec3d centre{0.11, -0.07, 0.05};
    PoissonBoltzmannOptions options;
    options.ionic_strength = 0;
    const Molecule ion = molecule_of({centre}, {2.0F}, {1.0F});
    const GridPtr map = pb_on_device(*engine, ion, pb_lattice(ion, 0.3, 10), options);
    check_radial(*engine, map, centre, 4, options.solvent_dielectric, 0.03);
    check_radial(*engine, map, centre, 7, options.solvent_dielectric, 0.02);
  }
}

TEST_CASE("affine functions have one gradient on skewed lattices in any frame, and none at the border") {
  Random random(64);
  Grid grid;
  grid.lattice.size = {14, 11, 17};
  grid.lattice.origin = {-31.5, 42.25, 17.0};
  grid.lattice.step = {{{0.9, 0.1, -0.05}, {0.3, 1.1, 0.15}, {-0.2, 0.25, 0.8}}};
  const Vec3d slope{0.7, -1.3, 0.45};
  for (std::size_t p = 0; p < grid.lattice.n_points(); ++p)
    grid.values.push_back(static_cast<float>(dot(slope, lattice_point(grid.lattice, p) - grid.lattice.origin)));
  const Vec3d middle =
      grid.lattice.origin + 6.5 * grid.lattice.step[0] + 5.0 * grid.lattice.step[1] + 8.0 * grid.lattice.step[2];
  for (const auto& engine : back_ends()) {
    const RigidTransform to_map = random_rigid(random, 40);
    RigidTransform back;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) back.rotation[3 * row + column] = to_map.rotation[3 * column + row];
    }
    const Vec3d expected = back.rotate(slope);
    const Vec3d centre = back.rotate(middle - to_map.translation);
    const GridPtr map = engine->upload_map(grid, to_map);
    for (const Vec3f& g : engine->sample_gradient(map, engine->upload_mesh(icosphere(2, 2.0, centre))))
      REQUIRE(norm(static_cast<Vec3d>(g) - expected) < 1e-4);
    std::size_t n_outside = 0;
    for (const Vec3f& g : engine->sample_gradient(map, engine->upload_mesh(icosphere(2, 8.0, centre))))
      n_outside += std::isnan(g.x) && std::isnan(g.y) && std::isnan(g.z) ? 1 : 0;
    CHECK(n_outside > 100);
  }
}

TEST_CASE("gradients of a periodic potential are the differences of its samples") {
  Random random(65);
  std::vector<Vec3d> positions;
  std::vector<float> charges;
  for (int i = 0; i < 20; ++i) {
    positions.push_back(random.in_box(8));
    charges.push_back(i % 2 == 0 ? 1.0F : -1.0F);
  }
  espdiff::PmeCell cell{{}, {{{20, 0, 0}, {3, 22, 0}, {0, 2, 24}}}};
  espdiff::PmeOptions options;
  options.size = {24, 24, 24};
  options.smooth_samples = true;
  for (const auto& engine : back_ends()) {
    for (const auto part : {espdiff::PmePart::kSmooth, espdiff::PmePart::kFull}) {
      options.part = part;
      const GridPtr map = engine->pme_potential(positions, charges, cell, options, {}, {});
      const Mesh sphere = icosphere(2, 11.0);
      const auto gradients = engine->sample_gradient(map, engine->upload_mesh(sphere));
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double kStep = 0.02;
        const auto shifted = [&](double by) {
          return engine->download(engine->sample(map, engine->upload_mesh(moved(sphere, [&](Vec3d p) {
            p[axis] += by;
            return p;
          }))));
        };
        const auto up = shifted(kStep), down = shifted(-kStep);
        double worst = 0, largest = 0;
        for (std::size_t v = 0; v < gradients.size(); ++v) {
          const double slope = static_cast<double>(up[v] - down[v]) / (2 * kStep);
          worst = std::max(worst, std::fabs(static_cast<double>(gradients[v][axis]) - slope));
          largest = std::max(largest, std::fabs(slope));
        }
        CHECK(worst < 0.01 * largest);
      }
    }
  }
}

TEST_SUITE_END();
