// compare_fields.cpp: reads fields on the two meshes of a mapping and compares them.
#include "compare/stages/compare_fields.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/triangle_areas.h"
#include "certificate/trusted_area.h"
#include "engine/engine.h"
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

ComparedFields compare_fields(Engine& engine, const std::vector<Field>& fields, const FieldsOfSide& source,
                              const FieldsOfSide& target, const CompareOptions& options, const MappedStep& step,
                              const CompareResult& result, std::vector<MeasuredPart>& parts) {
  ComparedFields compared;
  if (fields.empty()) return compared;
  const std::vector<float> untrusted = untrusted_triangles(result.surface);
  const float isovalue = static_cast<float>(options.surface.isovalue);
  const double offset_A = options.offsets_A.front();
  const PotentialUnit unit = result.potential.unit;
  const auto place = [&](const FieldsOfSide& side, const MeshPtr& mesh) {
    return FieldPlace{engine,
                      mesh,
                      moved_outside(engine, mesh, side.atoms, isovalue, offset_A),
                      side.molecule,
                      side.to_common,
                      side.atoms,
                      isovalue,
                      options.surface.radius_scale,
                      side.potential};
  };
  const FieldPlace on_source = place(source, step.mapping.source);
  FieldPlace on_target = place(target, step.mapping.mapped);
  on_target.left_out = result.surface.unmatched;
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
    field.residues = means_of(field, result.surface, result.residues.size());
    for (const StateField* of_state : {&source.fields[f], &target.fields[f]}) {
      field.files.insert(field.files.end(), of_state->files.begin(), of_state->files.end());
      for (const std::string& note : of_state->notes)
        compared.warnings.push_back({"field " + field.quantity.name + ": " + note, false});
    }
    if (!(field.metrics_all.area_A2 > 0)) compared.warnings.push_back({without_values(field), false});
    compared.fields.push_back(std::move(field));
  }
  return compared;
}

}  // namespace espdiff
