// angles_forms.cpp: the back ends' inverse trigonometric functions against the library's.
#include "cuda/device/angles.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace espdiff::cpu_backend;

TEST_CASE("angles of cosines and directions agree with the library's in every quadrant") {
  constexpr double kMost = 5e-7;
  for (int i = -2000; i <= 2000; ++i) {
    const float x = static_cast<float>(i) / 2000.0F;
    CAPTURE(x);
    CHECK(std::fabs(static_cast<double>(angle_of_cosine(x)) - std::acos(static_cast<double>(x))) < kMost);
  }
  for (int i = 0; i < 2000; ++i) {
    const double angle = 0.0031415926 * (i - 1000) + 1e-4;
    for (const double length : {1e-6, 1.0, 1e6}) {
      const auto x = static_cast<float>(length * std::cos(angle)), y = static_cast<float>(length * std::sin(angle));
      CAPTURE(x);
      CAPTURE(y);
      CHECK(std::fabs(static_cast<double>(angle_of_direction(y, x)) -
                      std::atan2(static_cast<double>(y), static_cast<double>(x))) < kMost);
    }
  }
  CHECK(angle_of_direction(0, 0) == 0);
  CHECK(angle_of_direction(0, 1) == 0);
  CHECK(std::fabs(angle_of_direction(0, -1) - 3.14159265F) < 1e-6F);
  CHECK(std::fabs(angle_of_direction(-2, 0) + 1.57079633F) < 1e-6F);
}
