// patches_of_fields.cpp: connected areas beyond thresholds of a comparison's fields.
#include "compare/stages/patches_of_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/formatted.h"
#include "certificate/result.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// A field's values in both states.
struct FieldValues {
  Quantity quantity;
  const std::vector<float>& source;
  const std::vector<float>& target;
};

FieldValues values_of(const std::string& name, const CompareResult& result) {
  const MappedSurface& s = result.surface;
  for (const FieldResult& field : result.fields) {
    if (field.quantity.name == name) return {field.quantity, field.source, field.target};
  }
  return {{"potential", "Potential", to_string(result.potential.unit), true}, s.potential_source, s.potential_target};
}

/// Says how far the values reach.
Warning without_patches(const FieldPatches& patches, const FieldValues& field) {
  float least = std::numeric_limits<float>::infinity(), largest = -least;
  for (const std::vector<float>* values : {&field.source, &field.target}) {
    for (const float value : *values) {
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      largest = std::max(largest, value);
    }
  }
  const std::size_t n_small = patches.n_small_source + patches.n_small_target;
  std::string text = "patches of " + to_string(patches.request) + ": neither state has a connected area of " +
                     formatted(kLeastFieldPatch_A2) + " A^2 there";
  if (n_small > 0) text += " (" + std::to_string(n_small) + " smaller ones were left out)";
  text += least > largest ? "; the field has no values"
                          : "; the values go from " + formatted("%.4g", static_cast<double>(least)) + " to " +
                                formatted("%.4g", static_cast<double>(largest)) +
                                (field.quantity.unit.empty() ? "" : " " + field.quantity.unit);
  return {text + ": take another threshold", false};
}

}  // namespace

void refuse_patches_of_potential(const CompareOptions& options) {
  for (const PatchesRequest& request : options.patches_of) {
    if (request.field == "potential")
      throw InputError(option("patches-of", to_string(request)) +
                       ": these states have no potential; give charges or maps, or another field");
  }
}

FoundPatches find_patches_of_fields(const CompareOptions& options, const CompareResult& result) {
  FoundPatches found;
  const MappedSurface& s = result.surface;
  for (const PatchesRequest& request : options.patches_of) {
    const FieldValues field = values_of(request.field, result);
    FieldPatches patches =
        find_field_patches(field.quantity, request, s.triangles, {s.source_positions, field.source, s.residue, {}},
                           {s.positions, field.target, s.target_residue, s.unmatched}, s.why);
    if (patches.source.empty() && patches.target.empty()) found.warnings.push_back(without_patches(patches, field));
    found.patches.push_back(std::move(patches));
  }
  return found;
}

}  // namespace espdiff
