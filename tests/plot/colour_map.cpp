// colour_map.cpp: the colour maps against published values and their requirements.
#include "plot/colour_map.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "base/error.h"

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

/// A colour as seen with one cone type missing, in CIE L*a*b*: G. Machado, M. Oliveira, L. Fernandes, IEEE TVCG 15,
/// 1291 (2009), severity 1.
struct Vision {
  const char* name;
  double matrix[9];
};

constexpr Vision kVisions[] = {
    {"full", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
    {"protanopia", {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998}},
    {"deuteranopia", {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881}},
    {"tritanopia", {1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900}}};

std::array<double, 3> seen(Rgb colour, const Vision& vision) {
  const auto linear = [](double encoded) {
    const double v = encoded / 255;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const double rgb[3] = {linear(colour.red), linear(colour.green), linear(colour.blue)};
  double s[3];
  for (int i = 0; i < 3; ++i) {
    const double* row = vision.matrix + 3 * i;
    s[i] = std::max(0.0, row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]);
  }
  const auto root = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = root((0.4124 * s[0] + 0.3576 * s[1] + 0.1805 * s[2]) / 0.95047);
  const double y = root(0.2126 * s[0] + 0.7152 * s[1] + 0.0722 * s[2]);
  const double z = root((0.0193 * s[0] + 0.1192 * s[1] + 0.9505 * s[2]) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

/// CIE 1976 difference; about 2 is just noticeable.
double distance(Rgb a, Rgb b, const Vision& vision) {
  const auto p = seen(a, vision), q = seen(b, vision);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

}  // namespace

TEST_CASE("signs are distinguishable with any colour vision") {
  for (const Vision& vision : kVisions) {
    INFO(std::string(vision.name));
    for (const char* name : {"red-blue", "cool-warm", "purple-orange"}) {
      const espdiff::DivergingMap& map = espdiff::diverging_map(name);
      CHECK(distance(diverging_colour(0, map), diverging_colour(1, map), vision) > 40);
      // At a third of the range already.
      CHECK(distance(diverging_colour(1 / 3.0, map), diverging_colour(2 / 3.0, map), vision) > 10);
      CHECK(distance(diverging_colour(0.5, map), diverging_colour(1, map), vision) > 40);
    }
    CHECK(distance(espdiff::kSameSignColour, espdiff::kSignChangeColour, vision) > 40);
  }
}

TEST_CASE("both ends of a diverging map are equally light, and colours without a name are refused") {
  for (const char* name : {"red-blue", "cool-warm", "purple-orange"}) {
    const espdiff::DivergingMap& map = espdiff::diverging_map(name);
    const auto low = seen(diverging_colour(0, map), kVisions[0]), high = seen(diverging_colour(1, map), kVisions[0]);
    CHECK(std::abs(low[0] - high[0]) < 2);
    CHECK(diverging_colour(0.5, map) == Rgb{221, 221, 221});
  }
  CHECK_THROWS_AS(espdiff::diverging_map("rainbow"), espdiff::InputError);
}

TEST_CASE("neighbours along the chain have unlike colours") {
  for (int i = 0; i < 300; ++i) {
    CHECK(distance(espdiff::residue_colour(i), espdiff::residue_colour(i + 1), kVisions[0]) > 30);
  }
  CHECK(espdiff::residue_colour(-1) == espdiff::kNoValueColour);
}

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
