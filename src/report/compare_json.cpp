// compare_json.cpp: a comparison's result as JSON.
#include "report/compare_json.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "align/geometry/rigid_domains.h"
#include "align/protonation.h"
#include "base/molecule/surface_parts.h"
#include "base/text/formats.h"
#include "certificate/result.h"
#include "compare/choose_motions.h"
#include "options/options.h"
#include "options/settings.h"
#include "report/field_patches_report.h"
#include "report/records/metrics.h"
#include "report/sections/causes_report.h"
#include "report/sections/field_json.h"
#include "report/sections/interface_report.h"
#include "report/sections/json_number.h"
#include "report/sections/placement.h"
#include "report/sections/potential_json.h"
#include "report/sections/preparation_json.h"
#include "report/sections/provenance.h"
#include "report/state_report.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(ValueOrigin origin) {
  switch (origin) {
    case ValueOrigin::kFile: return "file";
    case ValueOrigin::kElement: return "element";
    case ValueOrigin::kVmd: return "vmd";
    case ValueOrigin::kNone: break;
  }
  return "none";
}

/// Counts stay whole numbers.
Json number_of(const Metric& metric, double value) {
  if (metric.unit == MetricUnit::kCount && std::isfinite(value)) return static_cast<long long>(std::llround(value));
  return json_number(value);
}

/// Every metric at its place. What was not checked is null as a whole.
void add_metrics(Json& json, const MeasuredSurface& result) {
  for (const Metric& metric : metrics()) {
    if (!metric.has_result()) continue;
    const Json::json_pointer pointer(metric.json_pointer());
    if (is_unchecked(metric, result)) {
      json[pointer.parent_pointer()] = nullptr;
    } else {
      json[pointer] = number_of(metric, value_on(metric, result));
    }
  }
}

/// Each field under its name: what it is, its metrics, and what is left out.
/// @param part empty for the whole
Json compared_fields_json(const MeasuredSurface& result, const std::string& part) {
  Json json = Json::object();
  for (const FieldResult& field : result.fields) {
    Json& entry = json[field.quantity.name];
    entry = field_json(field.quantity, field.what, field.reference, field.files);
    if (!part.empty()) entry.erase("files");
    Json all;
    for (const Metric& metric : field_metrics(field.quantity)) {
      if (!metric.has_result()) continue;
      const std::string key = Json::json_pointer(metric.json_pointer()).back();
      entry[key] = json_number(value_on(metric, result));
      all[key] = json_number(value_over_all_triangles(metric, result));
    }
    entry["metrics_all_triangles"] = std::move(all);
    if (part.empty())
      entry["n_vertices_without_value"] = {{"source", field.n_missing_source}, {"target", field.n_missing_target}};
  }
  return json;
}

Json warnings(const CompareResult& result, const OptionSpelling& spelling) {
  Json json = Json::array();
  for (const Warning& warning : result.inputs.warnings)
    json.push_back({{"text", warning.text.spelled(spelling)}, {"refuses", warning.refuses}});
  return json;
}

void add_verdict(Json& json, const Certificate& c, const OptionSpelling& spelling) {
  json["zero_by_construction"] = Json::array();
  for (const Metric& metric : metrics()) {
    if (c.zero_by_construction && (metric.flags & kRemovable) != 0) json["zero_by_construction"].push_back(metric.name);
  }
  json["converged"] = c.converged;
  json["verdict"] = verdict_of(c);
  json["untrusted_parts"] = c.untrusted_parts;
  json["turned_side_chains"]["residues"] = c.turned.side_chains;
  json["trustworthy"] = c.trustworthy;
  json["reasons"] = Json::array();
  for (const Message& reason : c.reasons) json["reasons"].push_back(reason.spelled(spelling));
  json["not_checked"] = c.not_checked;
}

Json metrics_all_triangles(const CompareResult& result) {
  Json json;
  for (const Metric& metric : metrics()) {
    if (metric.source.of_area != nullptr) json[metric.name] = json_number(value_over_all_triangles(metric, result));
  }
  return json;
}

/// The metrics at each distance outside the surfaces, and what is left out there.
Json offsets(const CompareResult& result) {
  Json json = Json::array();
  for (const OffsetMetrics& at : result.potential.by_offset) {
    Json entry;
    entry["offset_A"] = json_number(at.offset_A);
    for (const Metric& metric : metrics()) {
      if (metric.source.of_area != nullptr) entry[metric.name] = json_number(at.metrics.*metric.source.of_area);
    }
    entry["n_vertices_inside"] = {{"source", at.n_inside_source}, {"target", at.n_inside_target}};
    entry["n_vertices_outside_map"] = {{"source", at.n_outside_source_map}, {"target", at.n_outside_target_map}};
    json.push_back(std::move(entry));
  }
  return json;
}

Json domains(const Molecule& source, const std::vector<RigidDomain>& all) {
  Json json = Json::array();
  for (const RigidDomain& domain : all)
    json.push_back({{"residues", residue_ranges(source, domain.residues)},
                    {"n_residues", domain.residues.size()},
                    {"n_superposed_atoms", domain.n_atoms},
                    {"rmsd_A", json_number(domain.rmsd_A)}});
  return json;
}

/// Runs [first atom of the source, first atom of the target, number of atoms], so that a file stays short.
Json paired_atoms(const AtomPairing& pairing) {
  std::vector<std::array<std::size_t, 3>> runs;
  for (const auto& [s, t] : pairing.pairs) {
    if (!runs.empty() && s == runs.back()[0] + runs.back()[2] && t == runs.back()[1] + runs.back()[2]) {
      ++runs.back()[2];
    } else {
      runs.push_back({s, t, 1});
    }
  }
  return runs;
}

Json superposition(const Molecule& source, const CompareResult& result) {
  const RigidTransform& t = result.alignment.source_to_target;
  Json rotation = Json::array();
  for (const double entry : t.rotation) rotation.push_back(json_number(entry));
  Json json;
  json["pairing"] = result.alignment.pairing.method;
  json["n_aligned_residues"] = result.alignment.pairing.n_aligned_residues;
  json["n_substituted_residues"] = result.alignment.pairing.n_substituted_residues;
  json["n_superposed_atoms"] = result.alignment.n_superposed_atoms;
  json["rotation_row_major"] = std::move(rotation);
  json["translation_A"] = {json_number(t.translation.x), json_number(t.translation.y), json_number(t.translation.z)};
  json["domains"] = domains(source, result.alignment.domains);
  json["paired_atoms"] = paired_atoms(result.alignment.pairing);
  return json;
}

/// What the mapping followed, and the other mapping where the pair was mapped twice.
Json motions(const CompareResult& result) {
  Json json{
      {"domains", result.mapping.domains},
      {"own_residue_area_fraction", json_number(own_residue_share(result.certificate, result.source_surface.area_A2,
                                                                  result.target_surface.area_A2))},
      {"because", nullptr},
      {"other", nullptr}};
  if (!result.mapping.other) return json;
  const OtherMapping& other = *result.mapping.other;
  json["because"] = other.because;
  json["other"] = {{"domains", other.domains},
                   {"own_residue_area_fraction", json_number(other.own_residue_area_fraction)},
                   {"beyond_3A_area_fraction", json_number(other.slip_area_fraction)},
                   {"same_residue_area_fraction", json_number(other.same_residue_area_fraction)},
                   {"no_counterpart_area_fraction",
                    {{"source", json_number(other.unmatched_source)}, {"target", json_number(other.unmatched_target)}}},
                   {"reasons", Json::array()}};
  for (const Message& reason : other.reasons) json["other"]["reasons"].push_back(reason.plain());
  return json;
}

Json surface(const SurfaceSummary& s) {
  return {{"n_vertices", s.n_vertices},        {"n_triangles", s.n_triangles},
          {"n_components", s.n_components},    {"n_cavities_left_out", s.n_cavities_left_out},
          {"area_A2", json_number(s.area_A2)}, {"cavity_area_A2", json_number(s.cavity_area_A2)}};
}

/// A setting's value, of the type that its kind says.
Json typed_value(const Setting& setting, const std::string& text) {
  switch (setting.kind) {
    case SettingKind::kNumber: return Json::parse(text).get<double>();
    case SettingKind::kInteger: return Json::parse(text);
    case SettingKind::kBoolean: return text == "1";
    case SettingKind::kChoice:
    case SettingKind::kText: break;
  }
  return text;
}

/// The result describes the computed map.
Json input_files(const Provenance& provenance, const CompareResult& result) {
  Json json = Json::array();
  for (const InputFile& input : provenance.inputs) {
    json.push_back({{"role", input.role}, {"path", input.path}, {"sha256", input.sha256}});
    const auto& made = input.role == "source_map" ? result.maps.source_recipe : result.maps.target_recipe;
    if (input.computed) json.back()["computed"] = recipe_json(made ? *made : *input.computed);
    if (!input.read_with) continue;
    json.back()["model"] = input.read_with->model;
    json.back()["hetero"] = input.read_with->include_hetero;
    json.back()["water"] = input.read_with->include_water;
  }
  return json;
}

Json chains(const CompareResult& result) {
  Json json;
  json["compared"] = Json::array();
  for (const ComparedChains& pair : result.inputs.chains)
    json["compared"].push_back({{"source", pair.source}, {"target", pair.target}, {"n_residues", pair.n_residues}});
  json["motions"] = Json::array();
  for (const ChainMotion& motion : result.alignment.chain_motions)
    json["motions"].push_back({{"source", motion.chain},
                               {"rotation_degrees", json_number(motion.rotation_degrees)},
                               {"shift_A", json_number(motion.shift_A)},
                               {"rmsd_A", json_number(motion.rmsd_A)},
                               {"own_rmsd_A", json_number(motion.own_rmsd_A)}});
  json["copies"] = {{"source", result.inputs.source_copies}, {"target", result.inputs.target_copies}};
  return json;
}

/// A region's or patch's metrics and certificate, under the names of the whole's.
Json part_json(const PartResult& part, const OptionSpelling& spelling) {
  Json json;
  json["n_residues"] = part.residues.size();
  json["residues"] = Json::array();
  for (const ResidueRow& row : part.residues) json["residues"].push_back(row.residue);
  add_metrics(json, part);
  json["fields"] = compared_fields_json(part, part.name);
  json["by_offset"] = Json::array();
  for (const OffsetMetrics& at : part.potential.by_offset) {
    Json entry{{"offset_A", json_number(at.offset_A)}};
    for (const Metric& metric : metrics()) {
      if (metric.source.of_area != nullptr) entry[metric.name] = json_number(at.metrics.*metric.source.of_area);
    }
    json["by_offset"].push_back(std::move(entry));
  }
  json["n_vertices_outside_map"] = {{"source", part.potential.n_outside_source_map},
                                    {"target", part.potential.n_outside_target_map}};
  add_verdict(json["certificate"], part.certificate, spelling);
  return json;
}

Json preparations(const Provenance& provenance) {
  Json json{{"source", nullptr}, {"target", nullptr}};
  for (const auto& [role, preparation] : provenance.preparations) json[role] = preparation_json(*preparation);
  return json;
}

/// What is said of how the states were read and prepared.
Json notes(const CompareResult& result) {
  Json json = Json::array();
  for (const auto& [label, text] : result.inputs.lines) json.push_back({{"label", label}, {"text", text}});
  return json;
}

void add_results(Json& json, const Molecule& source, const CompareResult& result, const OptionSpelling& spelling) {
  json["n_paired_atoms"] = result.alignment.pairing.pairs.size();
  json["potential_unit"] = result.potential.compared ? Json(potential_unit_text(result)) : Json(nullptr);
  json["potential"] = potential_json(result);
  json["shapes_because"] = result.inputs.shapes_because.empty() ? Json(nullptr) : Json(result.inputs.shapes_because);
  json["given_maps"] = given_maps_json(result);
  add_metrics(json, result);
  json["by_offset"] = offsets(result);
  json["notes"] = notes(result);
  json["warnings"] = warnings(result, spelling);
  add_verdict(json["certificate"], result.certificate, spelling);
  json["metrics_all_triangles"] = metrics_all_triangles(result);
  const WholeSurface whole = whole_surface(result.surface, result.residues, result.potential);
  json["whole_surface"] = {
      {"mean_abs_difference", {{"estimate", json_number(whole.estimate)}, {"at_most", json_number(whole.at_most)}}}};
  json["fields"] = compared_fields_json(result, "");
  json["region"] = nullptr;
  json["fixed_patches"] = Json::object();
  for (const PartResult& part : result.parts) {
    Json& entry = part.name == kRegionPart ? json["region"] : json["fixed_patches"][part.name];
    entry = part_json(part, spelling);
    if (part.placement != nullptr) entry["placement"] = placement_json(*part.placement);
  }
  json["causes"] = result.causes == nullptr ? Json::array() : causes_json(*result.causes, potential_unit_text(result));
  json["protonation_differences"] = Json::array();
  for (const ProtonationDifference& difference : result.inputs.protonation)
    json["protonation_differences"].push_back(in_words(difference, source));
  json["chains"] = chains(result);
  json["superposition"] = superposition(source, result);
  json["motions"] = motions(result);
  json["n_vertices"] = result.surface.positions.size();
  json["n_triangles"] = result.surface.triangles.size();
  json["n_components"] = result.source_surface.n_components;
  json["n_cavities_left_out"] = {{"source", result.source_surface.n_cavities_left_out},
                                 {"target", result.target_surface.n_cavities_left_out}};
  json["n_vertices_outside_map"] = {{"source", result.potential.n_outside_source_map},
                                    {"target", result.potential.n_outside_target_map}};
  json["surfaces"] = {{"source", surface(result.source_surface)}, {"target", surface(result.target_surface)}};
  json["start"] = result.mapping.start == StartFrom::kPrevious ? "previous" : "source";
  if (result.mapping.flow.sweeps > 0) {
    json["gvf"] = {{"sweeps", result.mapping.flow.sweeps},
                   {"residual", json_number(result.mapping.flow.residual)},
                   {"converged", result.mapping.flow.converged}};
  }
  json["n_vertices_added"] =
      result.mapping.morph.steps > 0 ? result.mapping.morph.n_vertices_added : result.mapping.n_vertices_subdivided;
  json["iterations_regularize"] = result.mapping.regularize.iterations;
}

}  // namespace

Json options_json(const std::vector<std::pair<std::string, std::string>>& texts) {
  Json json;
  for (const auto& [name, text] : texts) {
    const Setting& setting = find_setting(name);
    if (name != kThesisSetting) json[setting.key()] = typed_value(setting, text);
  }
  return json;
}

Json compare_json(const Molecule& source, const Molecule& target, const CompareResult& result,
                  const CompareOptions& options, const Provenance& provenance, const OptionSpelling& spelling) {
  Json json;
  json["format"] = kComparisonFormat;
  json["format_version"] = kFormatVersion;
  json["names"] = {{"source", source.name}, {"target", target.name}};
  add_results(json, source, result, spelling);
  json["field_patches"] = field_patches_json(source, target, result.field_patches);
  json["interface"] = result.interface == nullptr ? Json(nullptr) : interface_json(*result.interface);
  json["time_ms"] = Json::object();
  for (const auto& [stage, ms] : result.time_ms) json["time_ms"][stage] = json_number(ms);
  json["device"] = provenance.device;
  json["device_description"] = provenance.device_description;
  json["threads"] = provenance.threads;
  json["radii_origin"] = {{"source", name_of(source.radii_origin)}, {"target", name_of(target.radii_origin)}};
  json["preparation"] = preparations(provenance);
  json["options"] = options_json(setting_texts(options));
  json["inputs"] = input_files(provenance, result);
  json["command_line"] = provenance.command_line;
  json["version"] = provenance.version;
  return json;
}

}  // namespace espdiff
