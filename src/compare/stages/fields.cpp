// fields.cpp: reads fields on the two meshes of a mapping, compares them, and finds their patches.
#include "compare/stages/fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "base/triangle_areas.h"
#include "certificate/result.h"
#include "certificate/trusted_area.h"
#include "engine/engine.h"
#include "field/patches_request.h"
#include "field/read_field.h"
#include "mapping/sample_outside.h"
#include "options/options.h"

namespace espdiff {
namespace {

struct FieldComparison {
  Engine& engine;
  const MappedStep& step;
  ScalarsPtr at_source, at_target;

  /// @param left_out [triangle] nonzero where it does not count; empty includes all
  Metrics metrics(const std::vector<float>& left_out) const {
    return engine.compare(step.moved, step.mapping.mapped, at_source, at_target,
                          left_out.empty() ? nullptr : engine.upload_scalars(left_out));
  }
};

std::vector<float> larger_of(std::vector<float> a, const std::vector<float>& b) {
  for (std::size_t t = 0; t < b.size(); ++t) a[t] = std::max(a[t], b[t]);
  return a;
}

std::size_t count_missing(const std::vector<float>& values, const std::vector<bool>& counts) {
  std::size_t n = 0;
  for (std::size_t v = 0; v < values.size(); ++v) n += counts[v] && !std::isfinite(values[v]) ? 1 : 0;
  return n;
}

std::string without_values(const FieldResult& field) {
  return "field " + field.quantity.name + ": no point has a value in both states (" +
         std::to_string(field.n_missing_source) + " vertices of the source and " +
         std::to_string(field.n_missing_target) +
         " of the target have none), so that nothing was compared; a map has to lie where its structure does";
}

/// Means over triangles that are trusted and have values at all corners.
std::vector<ResidueMeans> means_of(const FieldResult& field, const MappedSurface& s, std::size_t n_residues) {
  const auto has_both = [&](std::uint32_t v) {
    return std::isfinite(field.source[v]) && std::isfinite(field.target[v]);
  };
  const auto counts = [&](std::size_t t) {
    return s.why[t] == 0 && std::all_of(s.triangles[t].begin(), s.triangles[t].end(), has_both);
  };
  return residue_means(corner_areas(s.positions, s.triangles, counts), s.residue, field.source, field.target,
                       n_residues);
}

/// A field's values in both states.
struct FieldValues {
  Quantity quantity;
  const std::vector<float>& source;
  const std::vector<float>& target;
};

FieldValues values_of(const std::string& name, const std::vector<FieldResult>& fields, const MappedSurface& s,
                      PotentialUnit unit) {
  for (const FieldResult& field : fields) {
    if (field.quantity.name == name) return {field.quantity, field.source, field.target};
  }
  return {{"potential", "Potential", to_string(unit), true}, s.potential_source, s.potential_target};
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

/// Adds the patches that the options ask for, of the compared fields and of the potential.
void find_patches(const CompareOptions& options, const MappedSurface& s, PotentialUnit unit, ComparedFields& compared) {
  for (const PatchesRequest& request : options.patches_of) {
    const FieldValues field = values_of(request.field, compared.fields, s, unit);
    FieldPatches patches =
        find_field_patches(field.quantity, request, s.triangles, {s.source_positions, field.source, s.residue, {}},
                           {s.positions, field.target, s.target_residue, s.unmatched}, s.why);
    if (patches.source.empty() && patches.target.empty()) compared.warnings.push_back(without_patches(patches, field));
    compared.patches.push_back(std::move(patches));
  }
}

}  // namespace

StateFields make_state_fields(const std::vector<Field>& fields, const Molecule& molecule, const FieldSide& side) {
  if (side.input.made != nullptr) return *side.input.made;
  StateFields made;
  for (const Field& field : fields) {
    try {
      made.push_back(field.make(molecule, side));
    } catch (const InputError& error) {
      throw InputError(option("field", field.quantity.name) + ": " + error.message());
    }
  }
  return made;
}

void refuse_fields_of_potential(const std::vector<Field>& fields) {
  for (const Field& field : fields) {
    if (!field.of_potential) continue;
    throw InputError(option("field", field.quantity.name) + ": '" + field.quantity.label +
                     "' is read from the potential, which these states lack; give charges or maps, or leave the field "
                     "out");
  }
}

ComparedFields compare_fields(Engine& engine, const std::vector<Field>& fields, const ComparedSide& source,
                              const ComparedSide& target, const CompareOptions& options, const MappedStep& step,
                              const MappedSurface& surface, PotentialUnit unit, std::vector<MeasuredPart>& parts) {
  ComparedFields compared;
  if (fields.empty()) {
    find_patches(options, surface, unit, compared);
    return compared;
  }
  const std::vector<float> untrusted = untrusted_triangles(surface);
  const float isovalue = static_cast<float>(options.surface.isovalue);
  const double offset_A = options.offsets_A.front();
  const auto place = [&](const ComparedSide& side, const MeshPtr& mesh, const RigidTransform& to_common) {
    return FieldPlace{engine,
                      mesh,
                      moved_outside(engine, mesh, side.surface.atoms, isovalue, offset_A),
                      *side.input.molecule,
                      to_common,
                      side.surface.atoms,
                      isovalue,
                      options.surface.radius_scale,
                      side.map.map};
  };
  const FieldPlace on_source = place(source, step.mapping.source, step.frame.from_source);
  FieldPlace on_target = place(target, step.mapping.mapped, step.frame.from_target);
  on_target.left_out = surface.unmatched;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    FieldResult field;
    field.quantity = fields[f].quantity;
    if (fields[f].of_potential) field.quantity.unit = unit == PotentialUnit::kUnknown ? "" : to_string(unit) + "/A";
    field.what = fields[f].what;
    field.reference = fields[f].reference;
    field.files = fields[f].files;
    field.source = read_field(source.fields[f], on_source);
    field.target = read_field(target.fields[f], on_target);
    field.n_missing_source = count_missing(field.source, step.is_matched);
    field.n_missing_target = count_missing(field.target, step.is_matched);
    set_unmatched_to_nan(step.is_matched, field.target);
    const FieldComparison comparison{engine, step, engine.upload_scalars(field.source),
                                     engine.upload_scalars(field.target)};
    field.metrics = comparison.metrics(untrusted);
    field.metrics_all = comparison.metrics(step.mapping.unmatched);
    for (MeasuredPart& part : parts) {
      FieldResult of_part;
      of_part.quantity = field.quantity;
      of_part.what = field.what;
      of_part.reference = field.reference;
      of_part.metrics = comparison.metrics(larger_of(part.place.outside, untrusted));
      of_part.metrics_all = comparison.metrics(larger_of(part.place.outside, step.mapping.unmatched));
      part.result.fields.push_back(std::move(of_part));
    }
    field.residues = means_of(field, surface, source.input.molecule->residues.size());
    for (const StateField* of_state : {&source.fields[f], &target.fields[f]}) {
      field.files.insert(field.files.end(), of_state->files.begin(), of_state->files.end());
      for (const std::string& note : of_state->notes)
        compared.warnings.push_back({"field " + field.quantity.name + ": " + note, false});
    }
    if (!(field.metrics_all.area_A2 > 0)) compared.warnings.push_back({without_values(field), false});
    compared.fields.push_back(std::move(field));
  }
  find_patches(options, surface, unit, compared);
  return compared;
}

void refuse_patches_of_potential(const CompareOptions& options) {
  for (const PatchesRequest& request : options.patches_of) {
    if (request.field == "potential")
      throw InputError(option("patches-of", to_string(request)) +
                       ": these states have no potential; give charges or maps, or another field");
  }
}

}  // namespace espdiff
