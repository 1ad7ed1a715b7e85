// colour_scale.cpp: ranges, rounding and the choice of a map for each array.
#include "view/colour_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace espdiff {
namespace {

struct ArrayDescription {
  const char* option;
  const char* name;
  const char* title;
};

/// In the order of RenderArray.
constexpr std::array<ArrayDescription, 5> kArrays = {{
    {"difference", "potential_difference", "potential difference, target \xE2\x88\x92 source"},
    {"source", "potential_source", "potential of the source"},
    {"target", "potential_target", "potential of the target"},
    {"sign", "sign_change", "sign of the potential, source against target"},
    {"displacement", "displacement", "distance to the counterpart"},
}};

const ArrayDescription& describe(RenderArray array) { return kArrays[static_cast<std::size_t>(array)]; }

/// Magnitude that 98 % of the values do not exceed: a few vertices in a crevice must not bleach all others.
double percentile_98(std::vector<float> magnitudes) {
  const auto rank = static_cast<std::size_t>(0.98 * static_cast<double>(magnitudes.size() - 1));
  std::nth_element(magnitudes.begin(), magnitudes.begin() + static_cast<std::ptrdiff_t>(rank), magnitudes.end());
  return magnitudes[rank];
}

}  // namespace

RenderArray parse_render_array(const std::string& text) {
  for (std::size_t i = 0; i < kArrays.size(); ++i) {
    if (text == kArrays[i].option) return static_cast<RenderArray>(i);
  }
  throw InputError("cannot colour by '" + text + "'; use difference, source, target, sign or displacement");
}

const char* array_name(RenderArray array) { return describe(array).name; }

std::string legend_title(RenderArray array, const std::string& unit) {
  const std::string title = describe(array).title;
  if (array == RenderArray::kSign) return title;
  const std::string shown = array == RenderArray::kDisplacement ? "\xC3\x85" : unit;
  return shown.empty() ? title : title + " (" + shown + ")";
}

double round_up_nicely(double value) {
  if (!(value > 0)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  // The tolerance keeps 0.3, which is 3.0000000000000004e-1 after the division, from becoming 0.4.
  for (const double factor : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (value <= factor * power * (1 + 1e-9)) return factor * power;
  }
  return 10 * power;
}

ColourScale::ColourScale(RenderArray array, const std::vector<float>& values, double limit) : array_(array) {
  if (!std::isfinite(limit) || limit < 0) {
    throw InputError("the colour range " + std::to_string(limit) +
                     " is not a positive number; leave it out for an automatic one");
  }
  std::vector<float> magnitudes;
  magnitudes.reserve(values.size());
  for (const float value : values) {
    if (std::isfinite(value)) magnitudes.push_back(std::abs(value));
  }
  if (magnitudes.empty()) {
    throw InputError(std::string("no vertex has a value in '") + array_name(array) +
                     "'; do the maps cover the molecules? Colour by displacement to see the shapes");
  }
  has_missing_ = magnitudes.size() < values.size();
  if (two_classes()) return;
  high_ = limit > 0 ? limit : round_up_nicely(percentile_98(std::move(magnitudes)));
  low_ = array == RenderArray::kDisplacement ? 0 : -high_;
  for (const float value : values) {
    exceeds_low_ = exceeds_low_ || value < low_;
    exceeds_high_ = exceeds_high_ || value > high_;
  }
}

Rgb ColourScale::colour(float value) const {
  if (!std::isfinite(value)) return kNoValueColour;
  if (two_classes()) return value != 0 ? kSignChangeColour : kSameSignColour;
  const double t = (value - low_) / (high_ - low_);
  return array_ == RenderArray::kDisplacement ? sequential_colour(t) : diverging_colour(t);
}

double OpacityScale::opacity(double displacement_A) const {
  if (std::isnan(displacement_A)) return least;
  if (displacement_A <= opaque_below_A) return 1;
  if (displacement_A >= faint_above_A) return least;
  return 1 - (1 - least) * (displacement_A - opaque_below_A) / (faint_above_A - opaque_below_A);
}

}  // namespace espdiff
