// sample.cpp: trilinear samples of potential maps on skewed lattices, from another frame.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "support/random.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;
using espdiff::RigidTransform;

namespace {

/// A lattice whose axes are neither orthogonal nor of one length.
Grid skewed_grid() {
  Grid grid;
  grid.lattice.size = {14, 11, 17};
  grid.lattice.origin = {-31.5, 42.25, 17.0};
  grid.lattice.step = {{{0.9, 0.1, -0.05}, {0.3, 1.1, 0.15}, {-0.2, 0.25, 0.8}}};
  grid.values.resize(grid.lattice.n_points());
  grid.name = "skewed.dx";
  return grid;
}

template <typename Function>
void fill(Grid& grid, Function f) {
  for (std::size_t p = 0; p < grid.values.size(); ++p)
    grid.values[p] = static_cast<float>(f(lattice_point(grid.lattice, p)));
}

RigidTransform inverse_of(const RigidTransform& t) {
  RigidTransform inverse;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) inverse.rotation[3 * row + column] = t.rotation[3 * column + row];
  }
  inverse.translation = -1.0 * inverse.rotate(t.translation);
  return inverse;
}

/// Lattice indices of a point, by Cramer's rule.
Vec3d index_of(const espdiff::Lattice& lattice, Vec3d p) {
  const Vec3d d = p - lattice.origin;
  const Vec3d &a = lattice.step[0], &b = lattice.step[1], &c = lattice.step[2];
  const double volume = dot(a, cross(b, c));
  return {dot(d, cross(b, c)) / volume, dot(a, cross(d, c)) / volume, dot(a, cross(b, d)) / volume};
}

/// Eight corners, weighted; NaN outside.
double sample_oracle(const Grid& grid, Vec3d p) {
  const Vec3d c = index_of(grid.lattice, p);
  double sum = 0;
  std::array<int, 3> base{};
  for (int axis = 0; axis < 3; ++axis) {
    const int n = grid.lattice.size[static_cast<std::size_t>(axis)];
    if (c[axis] < 0 || c[axis] > n - 1) return std::numeric_limits<double>::quiet_NaN();
    base[static_cast<std::size_t>(axis)] = std::min(static_cast<int>(c[axis]), n - 2);
  }
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::size_t index = 0, stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t a = static_cast<std::size_t>(axis);
      const double part = c[axis] - base[a];
      const int up = corner >> axis & 1;
      weight *= up != 0 ? part : 1 - part;
      index += stride * static_cast<std::size_t>(base[a] + up);
      stride *= static_cast<std::size_t>(grid.lattice.size[a]);
    }
    sum += weight * static_cast<double>(grid.values[index]);
  }
  return sum;
}

/// A mesh with vertices at the given lattice indices, in the common frame. The topology is an icosphere's.
Mesh mesh_at(const Grid& grid, const RigidTransform& to_common, Random& random, double low, double high) {
  Mesh mesh = icosphere(3, 1.0);
  for (Vec3f& p : mesh.positions) {
    Vec3d at = grid.lattice.origin;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t a = static_cast<std::size_t>(axis);
      at += (random.uniform(low, high) * (grid.lattice.size[a] - 1)) * grid.lattice.step[a];
    }
    p = static_cast<Vec3f>(to_common.apply(at));
  }
  return mesh;
}

}  // namespace

TEST_SUITE_BEGIN("sample");

TEST_CASE("affine functions are sampled exactly on skewed lattices in any frame") {
  Random random(60);
  Grid grid = skewed_grid();
  const Vec3d slope{0.7, -1.3, 0.45};
  const auto affine = [&](Vec3d p) { return 2.5 + dot(slope, p - grid.lattice.origin); };
  fill(grid, affine);
  for (const auto& engine : back_ends()) {
    for (int trial = 0; trial < 8; ++trial) {
      const RigidTransform to_map = random_rigid(random, 40), to_common = inverse_of(to_map);
      const Mesh mesh = mesh_at(grid, to_common, random, 1e-4, 1 - 1e-4);
      const auto samples =
          engine->download(engine->sample(engine->upload_map(grid, to_map), engine->upload_mesh(mesh)));
      REQUIRE(samples.size() == mesh.positions.size());
      double worst = 0;
      for (std::size_t v = 0; v < samples.size(); ++v) {
        REQUIRE(std::isfinite(samples[v]));
        const double exact = affine(to_map.apply(static_cast<Vec3d>(mesh.positions[v])));
        worst = std::max(worst, std::fabs(static_cast<double>(samples[v]) - exact));
      }
      CHECK(worst < 3e-6);  // values up to 35 in single precision: half a unit in the last place is 1.9e-6
    }
  }
}

TEST_CASE("samples of random maps equal a serial interpolation's, and NaN outside") {
  Random random(61);
  Grid grid = skewed_grid();
  for (float& value : grid.values) value = static_cast<float>(random.uniform(-5, 5));
  for (const auto& engine : back_ends()) {
    const RigidTransform to_map = random_rigid(random, 40);
    const Mesh mesh = mesh_at(grid, inverse_of(to_map), random, -0.3, 1.3);
    const auto samples = engine->download(engine->sample(engine->upload_map(grid, to_map), engine->upload_mesh(mesh)));
    double worst = 0;
    std::size_t n_outside = 0, n_disagree = 0;
    for (std::size_t v = 0; v < samples.size(); ++v) {
      const double exact = sample_oracle(grid, to_map.apply(static_cast<Vec3d>(mesh.positions[v])));
      n_disagree += std::isnan(exact) == std::isnan(samples[v]) ? 0 : 1;
      if (std::isnan(exact)) {
        ++n_outside;
      } else {
        worst = std::max(worst, std::fabs(static_cast<double>(samples[v]) - exact));
      }
    }
    CHECK(n_disagree == 0);
    CHECK(n_outside > 200);
    CHECK(n_outside < 600);
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("the border belongs to the map") {
  Grid grid;
  grid.lattice.size = {4, 3, 5};
  grid.lattice.origin = {-1, -2, -3};
  grid.lattice.step = {{{0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 2}}};
  grid.values.resize(grid.lattice.n_points());
  for (std::size_t p = 0; p < grid.values.size(); ++p) grid.values[p] = static_cast<float>(p);
  // A vertex on each corner of the map and one just outside each; the triangles of a tetrahedron need four.
  const auto sample_at = [&](Engine& engine, Vec3d p) {
    Mesh mesh = icosphere(0, 0.1, {-0.5, -1.9, 0});
    mesh.positions[0] = static_cast<Vec3f>(p);
    return engine.download(engine.sample(engine.upload_map(grid, {}), engine.upload_mesh(mesh)))[0];
  };
  for (const auto& engine : back_ends()) {
    for (int corner = 0; corner < 8; ++corner) {
      const std::size_t i = (corner & 1) != 0 ? 3 : 0, j = (corner & 2) != 0 ? 2 : 0, k = (corner & 4) != 0 ? 4 : 0;
      const Vec3d p{-1 + 0.5 * static_cast<double>(i), -2 + 0.25 * static_cast<double>(j),
                    -3 + 2 * static_cast<double>(k)};
      CHECK(sample_at(*engine, p) == static_cast<float>(i + 4 * (j + 3 * k)));
      for (int axis = 0; axis < 3; ++axis) {
        Vec3d outside = p;
        outside[axis] += (corner >> axis & 1) != 0 ? 1e-3 : -1e-3;
        CHECK(std::isnan(sample_at(*engine, outside)));
      }
    }
    CHECK(std::isnan(sample_at(*engine, {1e30, 0, 0})));
  }
}

TEST_CASE("a periodic map wraps around its cell and has no outside") {
  Random random(63);
  Grid grid = skewed_grid();
  for (float& value : grid.values) value = static_cast<float>(random.uniform(-5, 5));
  grid.periodic = true;
  // The same map with one more layer along each axis, which repeats the first.
  Grid closed = grid;
  for (int& n : closed.lattice.size) ++n;
  closed.periodic = false;
  closed.values.clear();
  const auto& size = grid.lattice.size;
  for (int k = 0; k <= size[2]; ++k) {
    for (int j = 0; j <= size[1]; ++j) {
      for (int i = 0; i <= size[0]; ++i)
        closed.values.push_back(
            grid.values[static_cast<std::size_t>(i % size[0] + size[0] * (j % size[1] + size[1] * (k % size[2])))]);
    }
  }
  for (const auto& engine : back_ends()) {
    const RigidTransform to_map = random_rigid(random, 40);
    const Mesh mesh = mesh_at(closed, inverse_of(to_map), random, 1e-4, 1 - 1e-4);
    const auto samples = engine->download(engine->sample(engine->upload_map(grid, to_map), engine->upload_mesh(mesh)));
    double worst = 0, worst_of_image = 0;
    RigidTransform to_image = to_map;  // two cells back along x, one forward along z
    for (int step = 0; step < size[0]; ++step) to_image.translation += -2.0 * grid.lattice.step[0];
    for (int step = 0; step < size[2]; ++step) to_image.translation += grid.lattice.step[2];
    const auto images = engine->download(engine->sample(engine->upload_map(grid, to_image), engine->upload_mesh(mesh)));
    for (std::size_t v = 0; v < samples.size(); ++v) {
      const double exact = sample_oracle(closed, to_map.apply(static_cast<Vec3d>(mesh.positions[v])));
      worst = std::max(worst, std::fabs(static_cast<double>(samples[v]) - exact));
      worst_of_image = std::max(worst_of_image, std::fabs(static_cast<double>(images[v] - samples[v])));
    }
    CHECK(worst < 1e-6);
    CHECK(worst_of_image < 1e-5);
    CHECK(engine->download(engine->upload_map(grid, {})).periodic);
  }
}

TEST_CASE("a map is downloaded as uploaded; one whose axes do not span space is refused") {
  Random random(62);
  Grid grid = skewed_grid();
  grid.unit = espdiff::PotentialUnit::kKtPerE;
  for (float& value : grid.values) value = static_cast<float>(random.uniform(-5, 5));
  for (const auto& engine : back_ends()) {
    const Grid back = engine->download(engine->upload_map(grid, random_rigid(random, 10)));
    CHECK(back.values == grid.values);
    CHECK(back.lattice.size == grid.lattice.size);
    CHECK(back.lattice.origin == grid.lattice.origin);
    CHECK(back.unit == grid.unit);
    Grid flat = grid;
    flat.lattice.step[2] = Vec3d{};
    CHECK_THROWS_AS(engine->upload_map(flat, {}), espdiff::InputError);
    CHECK(message_of([&] { engine->upload_map(flat, {}); }) == "skewed.dx: the map's axes do not span space");
  }
}

TEST_SUITE_END();
