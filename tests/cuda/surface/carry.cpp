// carry.cpp: points mapped by a mapping known at a mesh's vertices.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/shapes.h"
#include "engine/engine.h"

using namespace espdiff_test;

TEST_SUITE_BEGIN("carry");

TEST_CASE("a linear map is applied exactly to points of the surface") {
  const Mesh sphere = icosphere(3, 5), points = icosphere(2, 5);  // the coarse one's vertices are the fine one's
  const auto stretch = [](Vec3d p) { return Vec3d{2 * p.x + 1, p.y - 0.5 * p.x, 3 * p.z}; };
  for (const auto& engine : back_ends()) {
    const auto surface = engine->upload_mesh(sphere);
    const auto image = engine->with_positions(surface, moved(sphere, stretch).positions);
    const Mesh carried = engine->download(engine->carry(engine->upload_mesh(points), surface, image, 0.1));
    for (std::size_t v = 0; v < points.positions.size(); ++v) {
      const Vec3d expected = stretch(static_cast<Vec3d>(points.positions[v]));
      CHECK(norm(static_cast<Vec3d>(carried.positions[v]) - expected) < 1e-4);
    }
  }
}

TEST_CASE("a point beside the surface follows its foot; one too far away becomes NaN") {
  const Mesh sphere = icosphere(4, 5);
  for (const double height : {-0.3, 0.2, 0.4}) {
    const Mesh points = icosphere(1, 5 + height);
    for (const auto& engine : back_ends()) {
      const auto surface = engine->upload_mesh(sphere);
      const Mesh carried = engine->download(engine->carry(engine->upload_mesh(points), surface, surface, 0.35));
      for (std::size_t v = 0; v < points.positions.size(); ++v) {
        if (height > 0.35) {
          CHECK(std::isnan(carried.positions[v].x));
        } else {
          CHECK(static_cast<double>(norm(carried.positions[v])) == doctest::Approx(5).epsilon(0.005));
          CHECK(dot(carried.positions[v], points.positions[v]) >
                0.9999F * norm(carried.positions[v]) * norm(points.positions[v]));
        }
      }
    }
  }
}

TEST_CASE("an image of different topology is refused") {
  for (const auto& engine : back_ends()) {
    const auto a = engine->upload_mesh(icosphere(1, 1)), b = engine->upload_mesh(icosphere(2, 1));
    CHECK_THROWS_WITH_AS(engine->carry(a, a, b, 1), "carry: the surface and its image differ in topology",
                         espdiff::GeometryError);
  }
}

TEST_SUITE_END();
