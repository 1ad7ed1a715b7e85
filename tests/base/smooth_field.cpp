// smooth_field.cpp: tests of smoothing over neighbouring vertices, on an octahedron.
#include "base/smooth_field.h"

#include <doctest/doctest.h>
#include <cmath>
#include <limits>

namespace espdiff {
namespace {

/// Vertices 0 and 5 are the poles, 1 to 4 the equator.
const std::vector<Triangle> kOctahedron{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1},
                                        {5, 2, 1}, {5, 3, 2}, {5, 4, 3}, {5, 1, 4}};

TEST_CASE("a smoothed value is the mean of itself and its neighbours' mean") {
  const std::vector<float> once = smoothed_over_neighbours(kOctahedron, {8, 0, 0, 0, 0, 0}, 1);
  CHECK(once == std::vector<float>{4, 1, 1, 1, 1, 0});
  const std::vector<float> twice = smoothed_over_neighbours(kOctahedron, {8, 0, 0, 0, 0, 0}, 2);
  CHECK(twice == smoothed_over_neighbours(kOctahedron, once, 1));
  CHECK(smoothed_over_neighbours(kOctahedron, {8, 0, 0, 0, 0, 0}, 0).front() == 8);
}

TEST_CASE("smoothing keeps constants, and unknown values to themselves") {
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> smoothed = drawn_uncertainty(kOctahedron, {3, unknown, 3, 3, 3, 3});
  CHECK(std::isnan(smoothed[1]));
  for (const std::size_t v : {0, 2, 3, 4, 5}) CHECK(smoothed[v] == 3);
}

}  // namespace
}  // namespace espdiff
