// colour_scale.cpp: ranges, rounding and the choice of a map for each array.
#include "scene/colour_scale.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

struct ArrayDescription {
  const char* option;
  const char* name;
  const char* title;
};

/// In the order of RenderArray.
constexpr std::array<ArrayDescription, 10> kArrays = {{
    {"difference", "potential_difference", "potential difference, target \xE2\x88\x92 source"},
    {"source", "potential_source", "potential of the source"},
    {"target", "potential_target", "potential of the target"},
    {"sign", "sign_change", "sign of the potential, source against target"},
    {"displacement", "displacement", "distance to the counterpart"},
    {"magnitude", "potential_difference", "magnitude of the potential difference"},
    {"residue", "residue_index", "residues"},
    {"plain", "", "shape"},
    {"slip", "slip", "slip, distance from where the atoms went"},
    {"why", "why", "where it is trusted, and why not elsewhere"},
}};

const ArrayDescription& describe(RenderArray array) { return kArrays[static_cast<std::size_t>(array)]; }

void check(const ScaleRange& range) {
  if (!std::isfinite(range.limit) || range.limit < 0) {
    throw InputError("the colour range " + formatted(range.limit) +
                     " is not a positive number; leave it out for an automatic one");
  }
  if (!(range.percentile >= 50 && range.percentile <= 100)) {
    throw InputError("the percentile " + formatted(range.percentile) + " is out of range; use 50 to 100");
  }
  if (range.given_ends && !(std::isfinite(range.low) && std::isfinite(range.high) && range.low < range.high)) {
    throw InputError("the colour scale cannot go from " + formatted(range.low) + " to " + formatted(range.high) +
                     "; give the lower end first");
  }
}

}  // namespace

RenderArray parse_render_array(const std::string& text) {
  if (text == "uncertainty") return RenderArray::kSlip;
  for (std::size_t i = 0; i < kArrays.size(); ++i) {
    if (text == kArrays[i].option) return static_cast<RenderArray>(i);
  }
  throw InputError("cannot colour by '" + text +
                   "'; use difference, source, target, sign, displacement, magnitude, residue, plain, slip or why");
}

const char* to_string(RenderArray array) { return describe(array).option; }

std::vector<std::string> render_array_names() {
  std::vector<std::string> names;
  names.reserve(std::size(kArrays));
  for (const ArrayDescription& array : kArrays) names.emplace_back(array.option);
  return names;
}

const char* array_name(RenderArray array) { return describe(array).name; }

std::string legend_title(RenderArray array, const std::string& unit, const std::string& quantity) {
  std::string title = describe(array).title;
  const std::string potential = "potential";
  const std::size_t at = title.find(potential);
  if (at != std::string::npos) title.replace(at, potential.size(), quantity);
  const bool has_unit = array != RenderArray::kSign && array != RenderArray::kResidue && array != RenderArray::kPlain &&
                        array != RenderArray::kWhy;
  if (!has_unit) return title;
  const std::string shown = is_length(array) ? "\xC3\x85" : unit;
  return shown.empty() ? title : title + " (" + shown + ")";
}

ColourScale::ColourScale(RenderArray array, const std::vector<float>& values, double limit)
    : ColourScale(array, values, [limit] {
        ScaleRange range;
        range.limit = limit;
        return range;
      }()) {}

ColourScale::ColourScale(RenderArray array, const std::vector<float>& values, const ScaleRange& range,
                         const DivergingMap& map, bool is_signed)
    : array_(array), map_(map), is_signed_(is_signed) {
  check(range);
  if (!has_bar()) return;
  const auto is_missing = [](float value) { return !std::isfinite(value); };
  if (std::all_of(values.begin(), values.end(), is_missing)) {
    throw InputError(std::string("no vertex has a value in '") + array_name(array) +
                     "'; do the maps cover the molecules? Colour by displacement to see the shapes");
  }
  has_missing_ = std::any_of(values.begin(), values.end(), is_missing);
  if (two_classes()) return;
  set_ends(values, range);
  for (const float value : values) {
    const double shown = is_sequential() ? std::abs(value) : value;
    exceeds_low_ = exceeds_low_ || shown < low_;
    exceeds_high_ = exceeds_high_ || shown > high_;
  }
}

void ColourScale::set_ends(const std::vector<float>& values, const ScaleRange& range) {
  if (range.given_ends) {
    low_ = range.low;
    high_ = range.high;
    return;
  }
  high_ = range.limit > 0 ? range.limit : automatic_limit(values, range.percentile);
  low_ = is_sequential() ? 0 : -high_;
}

double ColourScale::hue() const { return is_length(array_) ? kGreenHue : kOrangeHue; }

Rgb ColourScale::colour(float value) const {
  if (array_ == RenderArray::kPlain || array_ == RenderArray::kWhy) return kPlainColour;
  if (!std::isfinite(value)) return kNoValueColour;
  if (array_ == RenderArray::kResidue) return residue_colour(static_cast<int>(value));
  if (two_classes()) return value != 0 ? kSignChangeColour : kSameSignColour;
  const double shown = is_sequential() ? std::abs(value) : value;
  const double t = (shown - low_) / (high_ - low_);
  return is_sequential() ? sequential_colour(t, hue()) : diverging_colour(t, map_);
}

std::vector<Rgb> ColourScale::table(std::size_t n) const {
  std::vector<Rgb> colours(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n - 1);
    colours[i] = array_ == RenderArray::kResidue ? residue_hue(t)
                 : is_sequential()               ? sequential_colour(t, hue())
                                                 : diverging_colour(t, map_);
  }
  return colours;
}

double OpacityScale::faded(double displacement_A) const {
  if (std::isnan(displacement_A) || displacement_A >= faint_above_A) return 1;
  if (displacement_A <= opaque_below_A) return 0;
  return (displacement_A - opaque_below_A) / (faint_above_A - opaque_below_A);
}

double OpacityScale::opacity(double displacement_A) const {
  return greatest - (greatest - least) * faded(displacement_A);
}

}  // namespace espdiff
