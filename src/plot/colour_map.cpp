// colour_map.cpp: computes the maps from colour-space geometry instead of tables.
#include "plot/colour_map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/vector.h"

namespace espdiff {
namespace {

struct Lab {
  double lightness = 0, a = 0, b = 0;
};

/// Reference white D65, as in sRGB.
constexpr double kWhiteX = 0.95047, kWhiteY = 1.0, kWhiteZ = 1.08883;

Lab to_lab(const Msh& msh) {
  const double chroma = msh.magnitude * std::sin(msh.saturation);
  return {msh.magnitude * std::cos(msh.saturation), chroma * std::cos(msh.hue), chroma * std::sin(msh.hue)};
}

/// Inverse of CIE's cube-root compression with its linear toe.
double expand(double f) {
  constexpr double kToe = 6.0 / 29.0;
  return f > kToe ? f * f * f : 3 * kToe * kToe * (f - 4.0 / 29.0);
}

std::uint8_t encode(double linear) {
  const double bounded = std::clamp(linear, 0.0, 1.0);
  const double gamma = bounded <= 0.0031308 ? 12.92 * bounded : 1.055 * std::pow(bounded, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * gamma));
}

Rgb to_srgb(const Lab& lab) {
  const double fy = (lab.lightness + 16) / 116;
  const double x = kWhiteX * expand(fy + lab.a / 500);
  const double y = kWhiteY * expand(fy);
  const double z = kWhiteZ * expand(fy - lab.b / 200);
  // IEC 61966-2-1: XYZ to linear sRGB.
  return {encode(3.2406 * x - 1.5372 * y - 0.4986 * z), encode(-0.9689 * x + 1.8758 * y + 0.0415 * z),
          encode(0.0557 * x - 0.2040 * y + 1.0570 * z)};
}

constexpr double kMiddleMagnitude = 88;

/// Hue of the unsaturated middle, on the path to a saturated end (Moreland's adjusted hue).
double hue_at_middle(const Msh& end) {
  // Changing the hue as the magnitude grows makes the perceived change at the end match the saturation's. The hue turns
  // away from purple, which keeps the arms apart.
  if (end.magnitude >= kMiddleMagnitude) return end.hue;
  const double growth = std::sqrt(kMiddleMagnitude * kMiddleMagnitude - end.magnitude * end.magnitude);
  const double spin = end.saturation * growth / (end.magnitude * std::sin(end.saturation));
  return end.hue > -kPi / 3 ? end.hue + spin : end.hue - spin;
}

}  // namespace

const DivergingMap& diverging_map(const std::string& name) {
  if (name == "red-blue") return kRedBlue;
  if (name == "cool-warm") return kCoolWarm;
  if (name == "purple-orange") return kPurpleOrange;
  throw InputError("no colours '" + name + "'; use red-blue, cool-warm or purple-orange");
}

Rgb diverging_colour(double t, const DivergingMap& map) {
  const double position = std::clamp(t, 0.0, 1.0);
  const Msh& end = position < 0.5 ? map.low : map.high;
  const double toward_end = std::abs(2 * position - 1);
  const double middle_hue = hue_at_middle(end);
  return to_srgb(to_lab({kMiddleMagnitude + toward_end * (end.magnitude - kMiddleMagnitude),
                         toward_end * end.saturation, middle_hue + toward_end * (end.hue - middle_hue)}));
}

Rgb sequential_colour(double t, double hue) {
  constexpr Lab kLight{95, 0, 0};
  constexpr double kDarkLightness = 28;
  const double position = std::clamp(t, 0.0, 1.0);
  // Chroma that rises fast and falls again stays inside sRGB at both ends.
  const double chroma = 42 * std::sin(kPi * (0.04 + 0.72 * position));
  return to_srgb({kLight.lightness + position * (kDarkLightness - kLight.lightness), chroma * std::cos(hue),
                  chroma * std::sin(hue)});
}

Rgb residue_hue(double turn) { return to_srgb(to_lab({82, 0.55, 2 * kPi * turn})); }

Rgb residue_colour(int index) {
  if (index < 0) return kNoValueColour;
  double whole = 0;
  return residue_hue(std::modf(0.61803399 * index, &whole));
}

}  // namespace espdiff
