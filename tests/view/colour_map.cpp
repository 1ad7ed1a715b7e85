// colour_map.cpp: the maps against published values and against what they are for.
#include "view/colour_map.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

using espdiff::diverging_colour;
using espdiff::Rgb;
using espdiff::sequential_colour;

namespace {

bool near(Rgb colour, Rgb expected, int tolerance) {
  return std::abs(colour.red - expected.red) <= tolerance && std::abs(colour.green - expected.green) <= tolerance &&
         std::abs(colour.blue - expected.blue) <= tolerance;
}

/// Relative luminance of an sRGB colour (IEC 61966-2-1).
double luminance(Rgb colour) {
  const auto linear = [](double encoded) {
    const double v = encoded / 255;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

}  // namespace

TEST_CASE("diverging map has the published ends and middle") {
  // Moreland (2009), cool to warm.
  CHECK(diverging_colour(0.0) == Rgb{59, 76, 192});
  CHECK(diverging_colour(0.5) == Rgb{221, 221, 221});
  CHECK(diverging_colour(1.0) == Rgb{180, 4, 38});
}

TEST_CASE("diverging map follows the published table in between") {
  // Rows of Moreland's 33-value table, which he computed with a slightly different matrix: one unit of rounding.
  CHECK(near(diverging_colour(4 / 32.0), {98, 130, 234}, 1));
  CHECK(near(diverging_colour(8 / 32.0), {141, 176, 254}, 1));
  CHECK(near(diverging_colour(12 / 32.0), {184, 208, 249}, 1));
  CHECK(near(diverging_colour(20 / 32.0), {245, 196, 173}, 1));
  CHECK(near(diverging_colour(24 / 32.0), {244, 154, 123}, 1));
  CHECK(near(diverging_colour(28 / 32.0), {222, 96, 77}, 1));
}

TEST_CASE("diverging map is brightest in the middle and clamps beyond its ends") {
  for (int i = 0; i < 64; ++i) {
    CHECK(luminance(diverging_colour(i / 128.0)) < luminance(diverging_colour((i + 1) / 128.0)));
    CHECK(luminance(diverging_colour(1 - i / 128.0)) < luminance(diverging_colour(1 - (i + 1) / 128.0)));
  }
  CHECK(diverging_colour(-3) == diverging_colour(0));
  CHECK(diverging_colour(7) == diverging_colour(1));
}

TEST_CASE("sequential map darkens steadily and stays green") {
  for (int i = 0; i < 100; ++i) {
    const Rgb colour = sequential_colour(i / 100.0);
    CHECK(luminance(colour) > luminance(sequential_colour((i + 1) / 100.0)));
    CHECK(colour.green >= colour.red);
    CHECK(colour.green >= colour.blue);
  }
  CHECK(sequential_colour(-1) == sequential_colour(0));
  CHECK(sequential_colour(2) == sequential_colour(1));
}

TEST_CASE("the two classes of the sign change, and no value, differ in lightness too") {
  CHECK(luminance(espdiff::kSameSignColour) > 2 * luminance(espdiff::kSignChangeColour));
  CHECK(luminance(espdiff::kSameSignColour) > 2 * luminance(espdiff::kNoValueColour));
}
