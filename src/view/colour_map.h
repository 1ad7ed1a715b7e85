// colour_map.h: the colours that values are drawn in: diverging, sequential and two-class maps.
#pragma once

#include <cstdint>

namespace espdiff {

/// An sRGB colour, 0 to 255 per channel.
struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
};

constexpr bool operator==(Rgb a, Rgb b) { return a.red == b.red && a.green == b.green && a.blue == b.blue; }

/// Vertices without a value, and triangles that are not trusted. Darker than any light end of the maps below.
inline constexpr Rgb kNoValueColour{128, 128, 128};
/// Two-class map of the sign change: told apart by readers with any colour vision, and in print without colour.
inline constexpr Rgb kSameSignColour{196, 214, 236};
inline constexpr Rgb kSignChangeColour{213, 94, 0};

/// Blue over light grey to red, for signed values: both arms are equally light at equal |value|.
/// Interpolates in Msh, the polar form of CIE L*a*b* (D65): M 80 at the ends, 88 at the neutral middle, the hue shifted
/// toward the middle so that perceived steps are even; then sRGB with its gamma. Method: K. Moreland, "Diverging Color
/// Maps for Scientific Visualization", ISVC 2009 (the ends are his).
/// @param t 0 (lowest value) to 1 (highest); clamped
Rgb diverging_colour(double t);

/// Near-white to dark green of one hue, evenly in CIE lightness, for magnitudes such as a displacement.
/// @param t 0 to 1; clamped
Rgb sequential_colour(double t);

}  // namespace espdiff
