// subdivide.cpp: stretched edges are split on both meshes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "cuda/certificate/mesh_checks.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"
#include "engine/surface_stage.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::MeshPtr;
using espdiff::SubdivisionResult;

namespace {

/// A sphere, and the same stretched to three times its length along x for x > 0.
struct Stretched {
  Mesh source_mesh, mapped_mesh;
  MeshPtr source, mapped;
};

Stretched stretched(Engine& engine) {
  Stretched s;
  s.source_mesh = icosphere(3, 3.0);
  s.mapped_mesh = moved(s.source_mesh, [](Vec3d p) { return p.x > 0 ? Vec3d{3 * p.x, p.y, p.z} : p; });
  s.source = engine.upload_mesh(s.source_mesh);
  std::vector<Vec3f> positions = s.mapped_mesh.positions;
  s.mapped = engine.with_positions(s.source, positions);
  return s;
}

double length(const std::vector<Vec3f>& x, const std::array<std::uint32_t, 2>& ends) {
  return static_cast<double>(norm(x[ends[0]] - x[ends[1]]));
}

}  // namespace

TEST_SUITE_BEGIN("subdivide");

TEST_CASE("only stretched edges beyond the limit are split, on both meshes, and both stay closed") {
  constexpr double kLimit = 1.0;
  for (const auto& engine : back_ends()) {
    const Stretched s = stretched(*engine);
    const SubdivisionResult halved = engine->subdivide(s.source, s.mapped, kLimit);
    const Mesh source = engine->download(halved.source), mapped = engine->download(halved.mapped);
    const std::size_t n = s.source_mesh.positions.size();
    CHECK(manifold_fault(mapped) == "");
    CHECK(source.triangles == mapped.triangles);
    REQUIRE(mapped.positions.size() == n + halved.ends.size());
    CHECK(std::equal(s.mapped_mesh.positions.begin(), s.mapped_mesh.positions.end(), mapped.positions.begin()));
    CHECK(std::equal(s.source_mesh.positions.begin(), s.source_mesh.positions.end(), source.positions.begin()));
    for (std::size_t k = 0; k < halved.ends.size(); ++k) {
      const auto& [a, b] = halved.ends[k];
      CHECK(length(s.mapped_mesh.positions, halved.ends[k]) > kLimit);
      CHECK(norm(mapped.positions[n + k] - 0.5F * (mapped.positions[a] + mapped.positions[b])) < 1e-5F);
      CHECK(norm(source.positions[n + k] - 0.5F * (source.positions[a] + source.positions[b])) < 1e-5F);
    }
    // Counts every long, stretched edge by brute force.
    std::size_t n_long = 0;
    for (const auto& t : s.source_mesh.triangles) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::array<std::uint32_t, 2> edge{t[c], t[(c + 1) % 3]};
        const double now = length(s.mapped_mesh.positions, edge);
        n_long += edge[0] < edge[1] && now > kLimit && now > length(s.source_mesh.positions, edge) ? 1 : 0;
      }
    }
    CHECK(n_long > 100);
    CHECK(halved.ends.size() == n_long);
    // A mapping that stretches nothing is not split, however short the limit.
    CHECK(engine->subdivide(s.source, s.source, 0.01).ends.empty());
  }
}

TEST_CASE("subdivide refuses meshes of different topology and an invalid limit") {
  for (const auto& engine : back_ends()) {
    const Stretched s = stretched(*engine);
    const MeshPtr other = engine->upload_mesh(s.source_mesh);
    CHECK(message_of([&] { engine->subdivide(other, s.mapped, 1.0); }) ==
          "subdivide: source and mapped mesh differ in topology");
    CHECK(message_of([&] { engine->subdivide(s.source, s.mapped, 0.0); }) == "the longest edge, 0 A, is not positive");
    CHECK_THROWS_AS(engine->subdivide(s.source, s.mapped, std::numeric_limits<double>::quiet_NaN()),
                    espdiff::InputError);
  }
}

TEST_SUITE_END();
