// colour_map.h: colour maps for values: diverging, sequential and two-class.
#pragma once

#include <cstdint>
#include <string>

namespace espdiff {

/// An sRGB colour, 0 to 255 per channel.
struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
};

constexpr bool operator==(Rgb a, Rgb b) { return a.red == b.red && a.green == b.green && a.blue == b.blue; }

/// Colour of vertices without a value and untrusted triangles. Darker than any light end of the maps below.
inline constexpr Rgb kNoValueColour{128, 128, 128};
/// Two-class map of the sign change, distinguishable with any colour vision and in grey print.
inline constexpr Rgb kSameSignColour{196, 214, 236};
inline constexpr Rgb kSignChangeColour{213, 94, 0};
/// A surface that shows only its shape.
inline constexpr Rgb kPlainColour{205, 208, 214};

/// Polar CIE L*a*b* (D65): magnitude, saturation angle from the lightness axis, hue angle (radians).
struct Msh {
  double magnitude = 0, saturation = 0, hue = 0;
};

/// A diverging map by its two ends; the middle is a neutral grey of magnitude 88.
struct DivergingMap {
  Msh low, high;
};

/// Blue over light grey to red: K. Moreland, "Diverging Color Maps for Scientific Visualization", ISVC 2009.
inline constexpr DivergingMap kCoolWarm{{80, 1.08, -1.1}, {80, 1.08, 0.5}};
/// The reverse: in pictures of potentials red is negative and blue positive.
inline constexpr DivergingMap kRedBlue{kCoolWarm.high, kCoolWarm.low};
/// Purple to orange, for readers who associate red and blue with acid and base, or for print beside red text.
inline constexpr DivergingMap kPurpleOrange{{68, 0.905, -0.9}, {70.5, 0.932, 1.03}};

/// Hue of the sequential maps, radians: green for displacements, orange for the magnitude of a difference.
inline constexpr double kGreenHue = 2.6179938779914944, kOrangeHue = 0.95;

/// @param name red-blue, cool-warm or purple-orange; all keep their arms distinct for red-green and blue-yellow
/// deficient vision
/// @throws InputError listing them
const DivergingMap& diverging_map(const std::string& name);

/// Signed values: both arms are equally light at equal |value|. Interpolates in Msh with the hue shifted toward the
/// middle for even perceived steps; then sRGB with its gamma.
/// @param t 0 (lowest value) to 1 (highest); clamped
Rgb diverging_colour(double t, const DivergingMap& map = kCoolWarm);

/// Near-white to dark in one hue, evenly in CIE lightness, for magnitudes such as a displacement.
/// @param t 0 to 1; clamped
Rgb sequential_colour(double t, double hue = kGreenHue);

/// The circle of residue hues.
/// @param turn 0 to 1
Rgb residue_hue(double turn);

/// Colours of residues: hues spaced by the golden ratio, so that neighbours along the chain differ. Negative: no
/// residue.
Rgb residue_colour(int index);

}  // namespace espdiff
