// colour_scale.h: from a value on a vertex to its colour and opacity, and what a legend must say about it.
#pragma once

#include <string>
#include <vector>

#include "view/colour_map.h"

namespace espdiff {

/// What a mapped surface is coloured by.
enum class RenderArray { kDifference, kSource, kTarget, kSign, kDisplacement };

/// @param text difference, source, target, sign or displacement
/// @throws InputError naming them
RenderArray parse_render_array(const std::string& text);

/// Name of the point array in the file, such as "potential_difference".
const char* array_name(RenderArray array);

/// The legend's title, such as "potential difference, target - source (kT/e)"; without parentheses for an empty unit.
std::string legend_title(RenderArray array, const std::string& unit);

/// Colours of one array. Potentials are diverging on [-limit, limit], displacements sequential on [0, limit], signs two
/// classes.
class ColourScale {
 public:
  /// @param values [vertex] of the array; NaN allowed
  /// @param limit  upper end of the scale, > 0; 0 takes the 98th percentile of |value|, rounded up to a round number
  /// @throws InputError when the limit is negative or not finite, or no value is finite
  ColourScale(RenderArray array, const std::vector<float>& values, double limit);

  Rgb colour(float value) const;
  double low() const { return low_; }
  double high() const { return high_; }
  bool two_classes() const { return array_ == RenderArray::kSign; }
  /// Whether values lie below or above the scale's ends, where they are drawn in the ends' colours.
  bool exceeds_low() const { return exceeds_low_; }
  bool exceeds_high() const { return exceeds_high_; }
  bool has_missing() const { return has_missing_; }

 private:
  RenderArray array_;
  double low_ = 0, high_ = 1;
  bool exceeds_low_ = false, exceeds_high_ = false, has_missing_ = false;
};

/// The next of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10 times a power of ten that is not below `value`; 1 for a value of 0.
double round_up_nicely(double value);

/// Opacity by how far a vertex moved to its counterpart: the farther, the less certain.
struct OpacityScale {
  double opaque_below_A = 0.5;  ///< displacement up to which the surface is opaque
  double faint_above_A = 3.0;   ///< displacement from which it has the least opacity; linear between
  double least = 0.25;          ///< 0 to 1

  double opacity(double displacement_A) const;
};

}  // namespace espdiff
