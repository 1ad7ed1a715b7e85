// compare_json.cpp: a comparison's result as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "align/rigid_domains.h"
#include "compare/options.h"
#include "compare/result.h"
#include "engine/certificate_stage.h"
#include "engine/deform_stage.h"
#include "report/potential_json.h"
#include "report/write_compare.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: what has no value is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// A value that exists with potentials only.
Json number_if(bool exists, double value) { return exists ? number(value) : Json(nullptr); }

const char* name_of(Interpolation interpolation) {
  return interpolation == Interpolation::kTricubic ? "tricubic" : "trilinear";
}

const char* name_of(ValueOrigin origin) {
  switch (origin) {
    case ValueOrigin::kFile: return "file";
    case ValueOrigin::kElement: return "element";
    case ValueOrigin::kVmd: return "vmd";
    case ValueOrigin::kNone: break;
  }
  return "none";
}

Json distances(const DistanceSummary& d) {
  return {{"mean", number(d.mean)},
          {"p95", number(d.p95)},
          {"max", number(d.max)},
          {"mean_within_limit", number(d.mean_within_limit)}};
}

Json certificate(const Certificate& c) {
  Json json;
  json["corrupt_area_fraction"] = number(c.corrupt_area_fraction);
  json["mapped_to_target_A"] = distances(c.mapped_to_target);
  json["target_to_mapped_A"] = distances(c.target_to_mapped);
  json["self_intersecting_pairs"] = c.self_intersecting_pairs;
  json["flipped_area_fraction"] = number(c.flipped_area_fraction);
  json["no_counterpart_area_fraction"] = {{"source", number(c.unmatched_source)},
                                          {"target", number(c.unmatched_target)}};
  json["round_trip"] = nullptr;
  if (c.round_trip) {
    json["round_trip"] = {{"mean_A", number(c.round_trip->mean_A)},
                          {"p95_A", number(c.round_trip->p95_A)},
                          {"max_A", number(c.round_trip->max_A)},
                          {"lost_target_area_fraction", number(c.round_trip->unmatched_target_area_fraction)}};
  }
  const DistortionReport& d = c.distortion;
  json["area_ratio"] = {
      {"p05", number(d.area_ratio_p05)}, {"median", number(d.area_ratio_median)}, {"p95", number(d.area_ratio_p95)}};
  json["symmetric_dirichlet"] = {{"median", number(d.dirichlet_median)}, {"p95", number(d.dirichlet_p95)}};
  json["same_residue_area_fraction"] = number(c.same_residue_area_fraction);
  json["irregularity_A"] = number(c.irregularity_A);
  json["converged"] = c.converged;
  json["trustworthy"] = c.trustworthy;
  json["reasons"] = c.reasons;
  json["not_checked"] = c.not_checked;
  return json;
}

/// The differences of potentials under the contract's names; all null without potentials.
void add_metrics(Json& json, bool exists, const Metrics& m) {
  json["mean_abs_difference"] = number_if(exists, m.mean_abs_difference);
  json["rms_difference"] = number_if(exists, m.rms_difference);
  json["mean_signed_difference"] = number_if(exists, m.mean_signed_difference);
  json["sign_change_area_fraction"] = number_if(exists, m.sign_change_area_fraction);
  json["hodgkin_index"] = number_if(exists, m.hodgkin_index);
  json["carbo_index"] = number_if(exists, m.carbo_index);
}

Json metrics_all_triangles(const CompareResult& result) {
  Json json;
  json["area_A2"] = number_if(result.has_potential, result.metrics_all.area_A2);
  add_metrics(json, result.has_potential, result.metrics_all);
  json["mean_displacement_A"] = number_if(result.has_potential, result.metrics_all.mean_displacement_A);
  json["mean_path_length_A"] = number_if(result.has_potential, result.metrics_all.mean_path_length_A);
  return json;
}

Json domains(const Molecule& source, const std::vector<RigidDomain>& all) {
  Json json = Json::array();
  for (const RigidDomain& domain : all)
    json.push_back({{"residues", residue_ranges(source, domain.residues)},
                    {"n_residues", domain.residues.size()},
                    {"n_superposed_atoms", domain.n_atoms},
                    {"rmsd_A", number(domain.rmsd_A)}});
  return json;
}

Json superposition(const Molecule& source, const CompareResult& result) {
  const RigidTransform& t = result.source_to_target;
  Json rotation = Json::array();
  for (const double entry : t.rotation) rotation.push_back(number(entry));
  Json json;
  json["pairing"] = result.pairing.method;
  json["n_aligned_residues"] = result.pairing.n_aligned_residues;
  json["n_substituted_residues"] = result.pairing.n_substituted_residues;
  json["n_superposed_atoms"] = result.n_superposed_atoms;
  json["rotation_row_major"] = std::move(rotation);
  json["translation_A"] = {number(t.translation.x), number(t.translation.y), number(t.translation.z)};
  json["domains"] = domains(source, result.domains);
  return json;
}

Json surface(const SurfaceSummary& s) {
  return {{"n_vertices", s.n_vertices},     {"n_triangles", s.n_triangles},
          {"n_components", s.n_components}, {"n_cavities_left_out", s.n_cavities_left_out},
          {"area_A2", number(s.area_A2)},   {"cavity_area_A2", number(s.cavity_area_A2)}};
}

Json iteration_options(const DeformOptions& o, double min_displacement_A) {
  return {{"sigma", o.sigma},
          {"mu", o.mu},
          {"rho", o.rho},
          {"max_iterations", o.max_iterations},
          {"min_displacement_A", min_displacement_A},
          {"interpolation", name_of(o.interpolation)},
          {"tangential_gain", o.tangential_gain},
          {"rest_shape", o.rest_shape}};
}

Json echo(const CompareOptions& o) {
  Json json;
  json["method"] = to_string(o.method);
  json["align"] = to_string(o.align);
  json["domains"] = o.domains;
  json["grid_spacing_A"] = o.surface.grid_spacing_A;
  json["radius_scale"] = o.surface.radius_scale;
  json["isovalue"] = o.surface.isovalue;
  json["cavities"] = o.surface.cavities;
  json["project"] = o.surface.project;
  json["field"] = to_string(o.field);
  json["distance_threshold_A"] = o.distance_threshold_A;
  json["gvf"] = {{"weight_A2", o.flow.weight_A2}, {"tolerance", o.flow.tolerance}, {"max_sweeps", o.flow.max_sweeps}};
  json["subdivide"] = o.subdivide;
  json["offsets_A"] = o.offsets_A;
  json["temperature_K"] = o.temperature_K;
  json["regularize"] = iteration_options(o.regularize, o.regularize_min_displacement * o.surface.grid_spacing_A);
  json["deform"] = iteration_options(o.deform, o.deform_min_displacement * o.surface.grid_spacing_A);
  json["morph"] = {{"max_step_A", o.morph.max_step_A},
                   {"max_edge_A", o.morph_max_edge * o.surface.grid_spacing_A},
                   {"max_stretch", o.morph.max_stretch}};
  return json;
}

/// What a computed map came out like is in the result.
Json input_files(const Provenance& provenance, const CompareResult& result) {
  Json json = Json::array();
  for (const InputFile& input : provenance.inputs) {
    json.push_back({{"role", input.role}, {"path", input.path}, {"sha256", input.sha256}});
    const auto& made = input.role == "source_map" ? result.source_recipe : result.target_recipe;
    if (input.computed) json.back()["computed"] = recipe_json(made ? *made : *input.computed);
    if (!input.read_with) continue;
    json.back()["model"] = input.read_with->model;
    json.back()["hetero"] = input.read_with->include_hetero;
    json.back()["water"] = input.read_with->include_water;
  }
  return json;
}

void add_results(Json& json, const Molecule& source, const CompareResult& result, const CompareOptions& options) {
  const CountedSurface counted = counted_surface(result);
  json["rmsd_A"] = number(result.rmsd_A);
  json["n_paired_atoms"] = result.pairing.pairs.size();
  json["potential_unit"] = result.has_potential ? Json(potential_unit_text(result)) : Json(nullptr);
  json["potential"] = potential_json(result);
  add_metrics(json, result.has_potential, result.metrics);
  json["by_offset"] = Json::array();
  for (const OffsetMetrics& at : result.by_offset) {
    Json entry;
    entry["offset_A"] = number(at.offset_A);
    entry["area_A2"] = number(at.metrics.area_A2);
    add_metrics(entry, true, at.metrics);
    entry["n_vertices_inside"] = {{"source", at.n_inside_source}, {"target", at.n_inside_target}};
    entry["n_vertices_outside_map"] = {{"source", at.n_outside_source_map}, {"target", at.n_outside_target_map}};
    json["by_offset"].push_back(std::move(entry));
  }
  json["area_A2"] = {{"source", number(result.source_surface.area_A2)},
                     {"target", number(result.target_surface.area_A2)},
                     {"mapped", number(result.area_mapped_A2)},
                     {"valid", number(counted.area_A2)}};
  json["mean_displacement_A"] = number(counted.mean_displacement_A);
  json["mean_path_length_A"] = number(counted.mean_path_length_A);
  json["certificate"] = certificate(result.certificate);
  json["metrics_all_triangles"] = metrics_all_triangles(result);
  json["superposition"] = superposition(source, result);
  json["n_vertices"] = result.surface.positions.size();
  json["n_triangles"] = result.surface.triangles.size();
  json["n_components"] = result.source_surface.n_components;
  json["n_cavities_left_out"] = {{"source", result.source_surface.n_cavities_left_out},
                                 {"target", result.target_surface.n_cavities_left_out}};
  json["n_vertices_outside_map"] = {{"source", result.n_outside_source_map}, {"target", result.n_outside_target_map}};
  json["surfaces"] = {{"source", surface(result.source_surface)}, {"target", surface(result.target_surface)}};
  json["start"] = result.start == StartFrom::kPrevious ? "previous" : "source";
  const bool morphed = options.method == Method::kMorph;
  json["iterations"] = morphed ? result.morph_report.steps : result.deform_report.iterations;
  if (result.flow_report.sweeps > 0) {
    json["gvf"] = {{"sweeps", result.flow_report.sweeps},
                   {"residual", number(result.flow_report.residual)},
                   {"converged", result.flow_report.converged}};
  }
  json["n_vertices_added"] = morphed ? result.morph_report.n_vertices_added : result.n_vertices_subdivided;
  json["iterations_regularize"] = result.regularize_report.iterations;
}

}  // namespace

std::string compare_json(const Molecule& source, const Molecule& target, const CompareResult& result,
                         const CompareOptions& options, const Provenance& provenance) {
  Json json;
  add_results(json, source, result, options);
  json["time_ms"] = Json::object();
  for (const auto& [stage, ms] : result.time_ms) json["time_ms"][stage] = number(ms);
  json["device"] = provenance.device;
  json["device_description"] = provenance.device_description;
  json["threads"] = provenance.threads;
  json["radii_origin"] = {{"source", name_of(source.radii_origin)}, {"target", name_of(target.radii_origin)}};
  json["options"] = echo(options);
  json["inputs"] = input_files(provenance, result);
  json["command_line"] = provenance.command_line;
  json["version"] = provenance.version;
  // A path need not be UTF-8, JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace espdiff
