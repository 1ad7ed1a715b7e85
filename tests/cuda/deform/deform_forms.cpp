// deform_forms.cpp: the force iteration in lanes and rings read whole, against one vertex and one neighbour after the
// other, to the bit. Compiled with the CPU back end's flags.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "cuda/deform/deform.h"
#include "cuda/deform/deform_iteration.h"
#include "cuda/surface/mesh/adjacency.h"
#include "cuda/surface/shapes.h"
#include "support/random.h"

using namespace espdiff_test;
using namespace espdiff::cpu_backend;
using espdiff::DeformOptions;
using espdiff::Vec4f;

namespace {

/// A sphere of 7 A, a double cone whose tips have 12 neighbours each, and a vertex in no triangle.
SurfaceMesh ball_cone_and_point() {
  Mesh mesh = icosphere(3, 7.0);
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (int i = 0; i < 12; ++i) {
    const double angle = espdiff::kPi * i / 6;
    mesh.positions.push_back(static_cast<Vec3f>(Vec3d{std::cos(angle), std::sin(angle), 0}));
  }
  mesh.positions.push_back({0, 0, 1});
  mesh.positions.push_back({0, 0, -1});
  mesh.positions.push_back({2, 1, 3});
  for (std::uint32_t i = 0; i < 12; ++i) {
    const std::uint32_t a = base + i, b = base + (i + 1) % 12;
    mesh.triangles.push_back({a, b, base + 12});
    mesh.triangles.push_back({b, a, base + 13});
  }
  std::vector<Corners> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({{t[0], t[1], t[2]}});
  Random random(3);
  std::vector<Vec4f> positions;
  for (const Vec3f p : mesh.positions)
    positions.push_back(espdiff::make_vec4(p + static_cast<Vec3f>(random.in_box(0.3)), 0));
  SurfaceMesh surface;
  surface.positions = to_device(positions);
  surface.topology = make_topology(positions.size(), to_device(triangles));
  return surface;
}

/// Random vectors; a fifth are zero. Vertices farther out than 5.5 A are beyond its border.
SurfaceField random_field() {
  SurfaceField field;
  field.lattice = {{12, 11, 13}, {-5.5F, -5.0F, -6.0F}, 1.0F};
  Random random(4);
  std::vector<Vec4f> values(field.lattice.n_points());
  for (Vec4f& value : values)
    if (random.uniform() > 0.2)
      value = espdiff::make_vec4(static_cast<Vec3f>(random.in_box(1)), static_cast<float>(random.uniform(-1, 1)));
  field.values = to_device(values);
  return field;
}

/// What an iteration reads and writes.
struct Run {
  DeformState state;
  Buffer<Vec4f> laplacians, rest;
  Buffer<float> path_lengths, strengths;

  Run(const SurfaceMesh& mesh, const SurfaceField& field, const DeformOptions& options)
      : laplacians(mesh.n_vertices()),
        rest(mesh.n_vertices(), Vec4f{0.01F, -0.02F, 0.03F, 0}),
        path_lengths(mesh.n_vertices(), 0.0F),
        strengths(mesh.n_vertices(), 1.0F) {
    state.positions = mesh.positions;
    state.moved = mesh.positions;
    Iteration& it = state.iteration;
    it.topology = mesh.view();
    it.lattice = field.lattice;
    it.field = raw(field.values);
    it.laplacian = raw(laplacians);
    it.rest = raw(rest);
    it.path_length = raw(path_lengths);
    it.strength = raw(strengths);
    it.tricubic = false;
    set_steps(it, options);
  }
};

template <typename T>
bool same_bits(const Buffer<T>& a, const Buffer<T>& b) {
  return a.size() == b.size() && std::memcmp(raw(a), raw(b), a.size() * sizeof(T)) == 0;
}

}  // namespace

TEST_SUITE_BEGIN("deform_forms");

TEST_CASE("a ring that is read whole has the sum of its neighbours, one after the other") {
  const SurfaceMesh mesh = ball_cone_and_point();
  const TopologyView topology = mesh.view();
  const Vec4f* const x = raw(mesh.positions);
  std::uint32_t fewest = 99, most = 0;
  for (std::size_t v = 0; v < mesh.n_vertices(); ++v) {
    const std::uint32_t begin = topology.first[v], end = topology.first[v + 1];
    fewest = std::min(fewest, end - begin);
    most = std::max(most, end - begin);
    Vec4f expected{};
    if (begin < end) {
      for (std::uint32_t n = begin; n < end; ++n) expected = expected + x[topology.neighbour[n]];
      expected = (1.0F / static_cast<float>(end - begin)) * expected - x[v];
    }
    const Vec4f found = umbrella(topology, x, v);
    CAPTURE(v);
    CHECK(std::memcmp(&found.x, &expected.x, sizeof(Vec4f)) == 0);
  }
  CHECK(fewest == 0);
  CHECK(most == 12);
}

TEST_CASE("vertices that move together have the bits of single ones") {
  const SurfaceMesh mesh = ball_cone_and_point();
  const SurfaceField field = random_field();
  const std::size_t n = mesh.n_vertices();
  REQUIRE(n % 32 != 0);  // some are left over
  DeformOptions options;
  options.max_iterations = 7;
  options.min_displacement_A = 0;
  options.momentum = 0.7;
  Run together(mesh, field, options), single(mesh, field, options);
  espdiff::DeformReport report;
  iterate_one_by_one(together.state, options, "deform", {}, report);
  REQUIRE(report.iterations == options.max_iterations);
  for (int k = 0; k < options.max_iterations; ++k) {
    Iteration now = single.state.iteration;
    now.from = raw(single.state.positions);
    now.to = raw(single.state.moved);
    for (std::size_t v = 0; v < n; ++v) take_laplacian(now, v);
    for (std::size_t v = 0; v < n; ++v) move_vertex(now, v);
    single.state.positions.swap(single.state.moved);
  }
  CHECK(same_bits(together.state.positions, single.state.positions));
  CHECK(same_bits(together.path_lengths, single.path_lengths));
  CHECK(same_bits(together.strengths, single.strengths));
  CHECK_FALSE(same_bits(together.state.positions, mesh.positions));
}

TEST_SUITE_END();
