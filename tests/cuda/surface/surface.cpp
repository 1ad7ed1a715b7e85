// surface.cpp: marching tetrahedra on synthetic atoms: closed manifolds, cavities, components, normals.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/surface_stage.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;

namespace {

/// Many components of a few atoms each, and a hollow one.
AtomSet scattered_atoms(std::uint64_t seed) {
  Random random(seed);
  AtomSet atoms = hollow_ball({0, 0, 0}, 7, 220);
  for (int n = 0; n < 80; ++n) atoms.add(random.in_box(18), random.uniform(0.8, 1.8));
  return atoms;
}

/// The number of crossing edges among the seven of every lattice point, and the number of triangles of the six
/// tetrahedra of every cell.
struct Counts {
  std::size_t vertices = 0, triangles = 0;
};

Counts expected_counts(const Grid& grid, float isovalue) {
  const int nx = grid.lattice.size[0], ny = grid.lattice.size[1], nz = grid.lattice.size[2];
  const auto inside = [&](int i, int j, int k, int corner) {
    const std::size_t p =
        static_cast<std::size_t>(i + (corner & 1)) +
        static_cast<std::size_t>(nx) * (static_cast<std::size_t>(j + (corner >> 1 & 1)) +
                                        static_cast<std::size_t>(ny) * static_cast<std::size_t>(k + (corner >> 2)));
    return grid.values[p] > isovalue;
  };
  Counts counts;
  for (int k = 0; k + 1 < nz; ++k) {
    for (int j = 0; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        for (int d = 1; d < 8; ++d) counts.vertices += inside(i, j, k, 0) != inside(i, j, k, d) ? 1 : 0;
        for (const int first : {1, 2, 4}) {  // the paths 0 -> one axis -> two axes -> 7
          for (const int second : {1, 2, 4}) {
            if (second == first) continue;
            const int n =
                inside(i, j, k, 0) + inside(i, j, k, first) + inside(i, j, k, first + second) + inside(i, j, k, 7);
            counts.triangles += n == 2 ? 2 : n == 1 || n == 3 ? 1 : 0;
          }
        }
      }
    }
  }
  return counts;
}

}  // namespace

TEST_SUITE_BEGIN("surface");

TEST_CASE(
    "random clouds give closed, consistently oriented manifolds with the vertices that the lattice has crossings") {
  for (const auto& engine : back_ends()) {
    for (std::uint64_t seed = 20; seed < 25; ++seed) {
      const AtomSet atoms = random_cloud(40 + 60 * (seed - 20), seed);
      for (const float isovalue : {0.1F, 0.5F, 2.5F}) {
        const auto density = engine->density(upload(*engine, atoms), 0.9);
        const auto surface = engine->isosurface(density, isovalue);
        const Mesh mesh = engine->download(surface);
        CAPTURE(seed);
        CAPTURE(isovalue);
        CHECK(manifold_fault(mesh) == "");
        CHECK(euler_characteristic(mesh) % 2 == 0);
        const Counts counts = expected_counts(engine->download(density), isovalue);
        CHECK(mesh.positions.size() == counts.vertices);
        CHECK(mesh.triangles.size() == counts.triangles);
        CHECK(engine->n_vertices(surface) == counts.vertices);
        CHECK(engine->n_triangles(surface) == counts.triangles);
      }
    }
  }
}

TEST_CASE("vertices lie where the linearly interpolated density on lattice edges is the isovalue") {
  for (const auto& engine : back_ends()) {
    const auto density = engine->density(upload(*engine, random_cloud(120, 30)), 1.0);
    const Grid grid = engine->download(density);
    const Mesh mesh = engine->download(engine->isosurface(density, 0.5F));
    double worst = 0;
    for (const Vec3f& vertex : mesh.positions) {
      // Whole indices at one end, by rounding down; the fraction gives the direction.
      Vec3d at{};
      std::array<int, 3> low{};
      double part = 0;
      std::size_t index = 0, stride = 1, step = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t a = static_cast<std::size_t>(axis);
        at[axis] = (static_cast<double>(vertex[axis]) - grid.lattice.origin[axis]) / grid.lattice.step[a][axis];
        low[a] = static_cast<int>(std::floor(at[axis] + 1e-4));
        const double fraction = at[axis] - low[a];
        index += stride * static_cast<std::size_t>(low[a]);
        if (fraction > 5e-4) {
          part = fraction;
          step += stride;
        }
        stride *= static_cast<std::size_t>(grid.lattice.size[a]);
      }
      REQUIRE(step > 0);
      const double a = static_cast<double>(grid.values[index]), b = static_cast<double>(grid.values[index + step]);
      if (std::fabs(a - b) < 1e-2 || part < 2e-3 || part > 1 - 2e-3)
        continue;  // moved off the lattice point on purpose
      worst = std::max(worst, std::fabs(a + part * (b - a) - 0.5));
    }
    CHECK(worst < 1e-4);  // single precision of the coordinates, times the slope
  }
}

TEST_CASE("a hollow ball has an outer surface of positive and a cavity of negative volume") {
  for (const auto& engine : back_ends()) {
    const Vec3d centre{3, -4, 5};
    const auto surface = engine->isosurface(engine->density(upload(*engine, hollow_ball(centre, 9, 400)), 1.0), 0.5F);
    const auto components = engine->components(surface);
    REQUIRE(components.size() == 2);
    const std::size_t outer = components[0].volume_A3 > 0 ? 0 : 1;
    CHECK(outer == 0);  // it starts at the lowest z, hence has the first vertex
    CHECK(components[outer].volume_A3 > 4 * kPi / 3 * 9 * 9 * 9);
    CHECK(components[1 - outer].volume_A3 < 0);
    CHECK(components[1 - outer].volume_A3 > -4 * kPi / 3 * 9 * 9 * 9);
    for (const auto& component : components) {
      CHECK(static_cast<int>(component.n_vertices) - static_cast<int>(component.n_triangles / 2) == 2);
    }

    const Mesh whole = engine->download(surface);
    int n_wrong = 0;
    for (std::size_t v = 0; v < whole.positions.size(); ++v) {
      const double along = dot(static_cast<Vec3d>(whole.positions[v]) - centre, static_cast<Vec3d>(whole.normals[v]));
      n_wrong += (along > 0) == (whole.component[v] == outer) ? 0 : 1;
    }
    CHECK(n_wrong == 0);  // out of the wall, on either side
    const auto kept = engine->keep_components(surface, {outer == 0, outer == 1});
    const Mesh mesh = engine->download(kept);
    CHECK(manifold_fault(mesh) == "");
    CHECK(mesh.positions.size() == components[outer].n_vertices);
    CHECK(mesh.triangles.size() == components[outer].n_triangles);
    CHECK(signed_volume(mesh) == doctest::Approx(components[outer].volume_A3).epsilon(1e-9));
    CHECK(engine->components(kept).size() == 1);
  }
}

TEST_CASE("components equal those of a union-find, and their sums add up to the mesh") {
  for (const auto& engine : back_ends()) {
    for (std::uint64_t seed = 40; seed < 46; ++seed) {
      const auto surface = engine->isosurface(engine->density(upload(*engine, scattered_atoms(seed)), 0.7), 0.5F);
      const Mesh mesh = engine->download(surface);
      const auto components = engine->components(surface);
      CAPTURE(seed);
      CHECK(components.size() > 3);
      CHECK(mesh.component == components_oracle(mesh));
      std::size_t n_vertices = 0, n_triangles = 0;
      double area = 0, volume = 0;
      for (const auto& component : components) {
        n_vertices += component.n_vertices;
        n_triangles += component.n_triangles;
        area += component.area_A2;
        volume += component.volume_A3;
      }
      CHECK(n_vertices == mesh.positions.size());
      CHECK(n_triangles == mesh.triangles.size());
      CHECK(area == doctest::Approx(engine->area(surface)).epsilon(1e-5));
      CHECK(volume == doctest::Approx(signed_volume(mesh)).epsilon(1e-9));
    }
  }
}

TEST_CASE("keep_components keeps the order of vertices and triangles") {
  for (const auto& engine : back_ends()) {
    const auto surface = engine->isosurface(engine->density(upload(*engine, scattered_atoms(47)), 0.7), 0.5F);
    const Mesh mesh = engine->download(surface);
    std::vector<bool> keep(engine->components(surface).size());
    for (std::size_t c = 0; c < keep.size(); ++c) keep[c] = c % 2 == 0;
    const Mesh kept = engine->download(engine->keep_components(surface, keep));
    std::vector<std::uint32_t> new_index(mesh.positions.size());
    std::vector<Vec3f> positions;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      new_index[v] = static_cast<std::uint32_t>(positions.size());
      if (keep[mesh.component[v]]) positions.push_back(mesh.positions[v]);
    }
    std::vector<espdiff::Triangle> triangles;
    for (const auto& t : mesh.triangles) {
      if (keep[mesh.component[t[0]]]) triangles.push_back({new_index[t[0]], new_index[t[1]], new_index[t[2]]});
    }
    CHECK(kept.positions == positions);
    CHECK(kept.triangles == triangles);

    keep.pop_back();
    CHECK(message_of([&] { engine->keep_components(surface, keep); }) ==
          "keep_components: needs one entry per component");
  }
}

TEST_CASE("normals are unit vectors that point outward") {
  for (const auto& engine : back_ends()) {
    const Vec3d centre{1, 2, 3};
    const auto surface = engine->isosurface(engine->density(upload(*engine, one_gaussian(centre, 2.5)), 0.5), 0.5F);
    const Mesh mesh = engine->download(surface);
    REQUIRE(mesh.normals.size() == mesh.positions.size());
    double least = 1, length_error = 0;
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
      const Vec3d n = static_cast<Vec3d>(mesh.normals[v]), outward = static_cast<Vec3d>(mesh.positions[v]) - centre;
      least = std::min(least, dot(n, outward) / norm(outward));
      length_error = std::max(length_error, std::fabs(norm(n) - 1));
    }
    CHECK(length_error < 1e-6);
    CHECK(least > 0.97);  // 14 degrees, at the thin triangles of marching tetrahedra
  }
}

TEST_CASE("no surface is an error that gives the highest density") {
  for (const auto& engine : back_ends()) {
    const auto density = engine->density(upload(*engine, one_gaussian({0, 0, 0}, 1.5)), 1.0);
    CHECK_THROWS_AS(engine->isosurface(density, 1.5F), espdiff::GeometryError);
    const std::string text = message_of([&] { engine->isosurface(density, 1.5F); });
    CHECK(text.find("no surface: the density reaches ") == 0);
    CHECK(text.find("never exceeds the isovalue 1.5") != std::string::npos);
    CHECK(text.find("lower the isovalue") != std::string::npos);
  }
}

TEST_SUITE_END();
