// orientation.cpp: the automatic viewing direction.
#include "scene/orientation.h"

#include <doctest/doctest.h>

#include <limits>

using espdiff::choose_orientation;
using espdiff::Orientation;
using espdiff::Vec3d;

namespace {

/// Corners and face centres of a box of half sides 1, 2 and 3, off the origin; `value` on the face at low x.
struct Box {
  std::vector<Vec3d> positions;
  std::vector<float> values;

  explicit Box(float value) {
    for (int corner = 0; corner < 8; ++corner) {
      const double x = (corner & 1) != 0 ? 1 : -1;
      positions.push_back({10 + x, (corner & 2) != 0 ? 2.0 : -2.0, (corner & 4) != 0 ? 3.0 : -3.0});
      values.push_back(x < 0 ? value : 0.5F);
    }
  }
};

}  // namespace

TEST_CASE("the shortest axis points at the viewer, and the coloured side is the front") {
  const Box box(-7);
  const Orientation view = choose_orientation(box.positions, box.values, true, 2);
  CHECK(view.toward_viewer.x == doctest::Approx(-1));
  CHECK(view.up.z == doctest::Approx(1));
  CHECK(view.half_height_A == doctest::Approx(3));
  CHECK(view.half_width_A == doctest::Approx(2));
  CHECK(view.centre.x == doctest::Approx(10));
  CHECK(view.radius_A == doctest::Approx(std::sqrt(14.0)));
}

TEST_CASE("vertices without a value do not decide the front") {
  const Box box(std::numeric_limits<float>::quiet_NaN());
  CHECK(choose_orientation(box.positions, box.values, true, 2).toward_viewer.x == doctest::Approx(1));
}

TEST_CASE("a wide picture has the longest axis across, and its frame is right-handed") {
  const Box box(-7);
  const Orientation view = choose_orientation(box.positions, box.values, false, 2);
  CHECK(std::abs(view.right.z) == doctest::Approx(1));
  CHECK(view.up.y == doctest::Approx(1));
  const Vec3d across = cross(view.right, view.up);
  CHECK(dot(across, view.toward_viewer) == doctest::Approx(1));
}

TEST_CASE("turned views leave room for the widest view") {
  const Box box(-7);
  CHECK(choose_orientation(box.positions, box.values, true, 4).half_width_A == doctest::Approx(std::hypot(1, 2)));
}
