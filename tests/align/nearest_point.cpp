// nearest_point.cpp: the tree against a look at every point.
#include "align/geometry/nearest_point.h"

#include <random>

#include "support/test_data.h"

using espdiff::NearestPoint;
using espdiff::Vec3d;

namespace {

std::size_t by_looking(const std::vector<Vec3d>& points, const Vec3d& p) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3d d = points[i] - p, least = points[nearest] - p;
    if (dot(d, d) < dot(least, least)) nearest = i;
  }
  return nearest;
}

}  // namespace

TEST_SUITE_BEGIN("compare");

TEST_CASE("nearest point: as by looking at all, the first of those that are as near") {
  std::mt19937 random(7);
  for (const bool on_lattice : {false, true}) {
    CAPTURE(on_lattice);
    std::uniform_real_distribution<double> anywhere(-20, 20);
    std::uniform_int_distribution<int> lattice(-3, 3);  // many at the same distance, and many twice
    const auto point = [&] {
      if (on_lattice) return Vec3d{1.0 * lattice(random), 1.0 * lattice(random), 1.0 * lattice(random)};
      return Vec3d{anywhere(random), anywhere(random), 0.1 * anywhere(random)};
    };
    for (const std::size_t n : {1U, 2U, 3U, 500U}) {
      std::vector<Vec3d> points(n);
      for (Vec3d& p : points) p = point();
      const NearestPoint nearest(points);
      for (int i = 0; i < 500; ++i) {
        Vec3d p = point();
        if (i % 10 == 0) p = 100.0 * p;
        REQUIRE(nearest(p) == by_looking(points, p));
      }
    }
  }
}

TEST_SUITE_END();
