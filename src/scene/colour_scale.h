// colour_scale.h: maps a vertex's value to colour and opacity, and provides the legend's numbers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "plot/automatic_range.h"
#include "plot/colour_map.h"

namespace espdiff {

/// The quantity that colours a mapped surface. The numbers are those of shaders/surface.frag.
enum class RenderArray {
  kDifference,
  kSource,
  kTarget,
  kSign,
  kDisplacement,
  kMagnitude,
  kResidue,
  kPlain,
  kSlip,
  kWhy
};

/// Whether an array compares a place of the source with its place on the target; grey where that is not trusted.
inline bool compares_places(RenderArray array) {
  return array == RenderArray::kDifference || array == RenderArray::kSign || array == RenderArray::kDisplacement ||
         array == RenderArray::kMagnitude;
}

/// Whether an array says how certain the mapping is, so that nothing fades by that.
inline bool shows_certainty(RenderArray array) {
  return array == RenderArray::kDisplacement || array == RenderArray::kSlip || array == RenderArray::kWhy;
}

/// Whether an array is of lengths, in Angstrom; the others are potentials or have no unit.
inline bool is_length(RenderArray array) { return array == RenderArray::kDisplacement || array == RenderArray::kSlip; }

/// @param text difference, source, target, sign, displacement, magnitude, residue, plain, slip (or uncertainty) or why
/// @throws InputError listing them
RenderArray parse_render_array(const std::string& text);
/// The name that parse_render_array() reads.
const char* to_string(RenderArray array);
/// All of them, in order.
std::vector<std::string> render_array_names();

/// Name of the point array in the file, such as "potential_difference"; empty for plain.
const char* array_name(RenderArray array);

/// The legend's title, such as "potential difference, target - source (kT/e)"; without parentheses for an empty unit.
/// @param quantity in the place of the potential
std::string legend_title(RenderArray array, const std::string& unit, const std::string& quantity = "potential");

/// How the ends of a scale are chosen.
struct ScaleRange {
  double limit = 0;  ///< > 0: the upper end; for signed values both ends. 0: automatic_limit() at the percentile
  double percentile = kAutomaticPercentile;  ///< 50 to 100
  bool given_ends = false;                   ///< the scale goes from `low` to `high`
  double low = 0, high = 0;
};

/// Colours of one array. Potentials are diverging on [-limit, limit], displacements and magnitudes sequential on [0,
/// limit], signs two classes, residues one colour each.
class ColourScale {
 public:
  /// @param values [vertex] of the array; NaN allowed
  /// @throws InputError if the range is invalid (not finite, negative, empty, a percentile out of bounds) or no value
  /// is finite
  /// @param is_signed of the quantity; the values of one that is not are drawn from 0 on in one hue
  ColourScale(RenderArray array, const std::vector<float>& values, const ScaleRange& range,
              const DivergingMap& map = kRedBlue, bool is_signed = true);
  ColourScale(RenderArray array, const std::vector<float>& values, double limit);

  RenderArray array() const { return array_; }
  Rgb colour(float value) const;
  /// n colours from the low end to the high end; for residues, the circle of hues.
  std::vector<Rgb> table(std::size_t n) const;
  double low() const { return low_; }
  double high() const { return high_; }
  bool two_classes() const { return array_ == RenderArray::kSign; }
  /// Whether a legend shows a bar; residues, plain surfaces and reasons have none.
  bool has_bar() const {
    return array_ != RenderArray::kResidue && array_ != RenderArray::kPlain && array_ != RenderArray::kWhy;
  }
  /// Whether values lie beyond the scale's ends, where they are drawn in the ends' colours.
  bool exceeds_low() const { return exceeds_low_; }
  bool exceeds_high() const { return exceeds_high_; }
  bool has_missing() const { return has_missing_; }

 private:
  double hue() const;
  bool is_sequential() const {
    const bool is_one_side = array_ == RenderArray::kSource || array_ == RenderArray::kTarget;
    return array_ == RenderArray::kMagnitude || is_length(array_) || (is_one_side && !is_signed_);
  }
  void set_ends(const std::vector<float>& values, const ScaleRange& range);

  RenderArray array_;
  DivergingMap map_;
  bool is_signed_ = true;
  double low_ = 0, high_ = 1;
  bool exceeds_low_ = false, exceeds_high_ = false, has_missing_ = false;
};

/// Opacity by slip (by displacement where a file has no slip): the farther, the less certain the correspondence.
struct OpacityScale {
  double opaque_below_A = 0.5;  ///< displacement up to which the surface is opaque
  double faint_above_A = 3.0;   ///< displacement from which it has the least opacity; linear between
  double least = 0.25;          ///< 0 to 1
  double greatest = 1;          ///< opacity of certain parts, 0 to 1
  bool to_grey = false;         ///< fades to dark grey instead, and stays opaque

  double faded(double displacement_A) const;  ///< 0 to 1; NaN is as uncertain as can be
  double opacity(double displacement_A) const;
};

}  // namespace espdiff
