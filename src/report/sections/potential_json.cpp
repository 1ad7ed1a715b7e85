// potential_json.cpp: what a result tells of its computed potentials.
#include "report/sections/potential_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "certificate/result.h"
#include "input_checks/map_check.h"
#include "report/sections/json_number.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

Json vector(const Vec3d& v) { return {json_number(v.x), json_number(v.y), json_number(v.z)}; }

const char* name_of(DielectricBoundary boundary) {
  switch (boundary) {
    case DielectricBoundary::kMolecular: return "molecular";
    case DielectricBoundary::kVanDerWaals: return "vdw";
    case DielectricBoundary::kGaussian: break;
  }
  return "gaussian";
}

void add_pme(Json& json, const MapRecipe& r) {
  const auto& edges = r.cell.edges;
  json["part"] = r.pme.part == PmePart::kFull ? "full" : "smooth";
  json["cell_from"] = r.cell_from;
  json["cell_centre_A"] = vector(r.cell.centre);
  json["cell_edges_A"] = {vector(edges[0]), vector(edges[1]), vector(edges[2])};
  json["grid"] = r.pme.size;
  json["spline_order"] = r.pme.order;
  json["ewald_factor"] = json_number(r.pme.ewald_factor);
  json["compatible"] = r.pme.compatible;
  json["precision"] = r.pme.precision == Precision::kDouble ? "double" : "single";
  json["sampling"] = r.pme.smooth_samples ? "spline" : "trilinear";
  json["temperature_K"] = json_number(r.pme.temperature_K);
  if (r.made) json["bulk_fraction"] = json_number(r.bulk_fraction);
}

void add_pb(Json& json, const MapRecipe& r) {
  const PoissonBoltzmannOptions& o = r.pb;
  json["equation"] = o.nonlinear ? "nonlinear" : "linear";
  json["solute_dielectric"] = json_number(o.solute_dielectric);
  json["solvent_dielectric"] = json_number(o.solvent_dielectric);
  json["ionic_strength_M"] = json_number(o.ionic_strength);
  json["ion_radius_A"] = json_number(o.ion_radius_A);
  json["dielectric_boundary"] = name_of(o.dielectric_boundary);
  json["dielectric_smoothing"] = o.smoothing == DielectricSmoothing::kEdges ? "edges" : "nine-point";
  json["probe_radius_A"] = json_number(o.probe_radius_A);
  json["gaussian_sigma"] = json_number(o.gaussian_sigma);
  json["far_boundary"] = o.far_boundary == FarBoundary::kFocus ? "focus" : "debye-hueckel";
  json["tolerance"] = json_number(o.tolerance);
  json["max_cycles"] = o.max_cycles;
  json["temperature_K"] = json_number(o.temperature_K);
  json["spacing_A"] = json_number(r.pb_spacing_A);
  if (!r.made) return;
  const PoissonBoltzmannReport& report = r.pb_report;
  json["grid"] = r.pb_lattice.size;
  json["grid_origin_A"] = vector(r.pb_lattice.origin);
  json["start_residual"] = json_number(report.start_residual);
  json["relative_residual"] = json_number(report.relative_residual);
  json["surface_error"] = json_number(report.surface_error);
  json["cycles"] = report.cycles;
  json["newton_steps"] = report.newton_steps;
  json["levels"] = report.levels;
  json["bytes_per_point"] = json_number(report.bytes_per_point);
  json["debye_length_A"] = json_number(report.debye_length_A);
}

}  // namespace

Json recipe_json(const MapRecipe& r) {
  Json json;
  json["method"] = to_string(r.method);
  json["label"] = potential_label(r);
  json["charges_from"] = r.charges_from;
  json["n_charges"] = r.n_charges;
  json["net_charge"] = json_number(r.net_charge);
  json["explicit_water"] = r.has_water;
  if (r.n_frames > 1) json["frames"] = r.n_frames;
  if (r.method == PotentialMethod::kPme) add_pme(json, r);
  if (r.method == PotentialMethod::kPoissonBoltzmann) add_pb(json, r);
  if (r.method == PotentialMethod::kCoulomb) {
    json["dielectric"] = json_number(r.coulomb.dielectric);
    json["distance_dependent"] = r.coulomb.distance_dependent;
    json["temperature_K"] = json_number(r.coulomb.temperature_K);
  }
  json["zero"] = to_string(r.zero);
  if (r.made) json["subtracted"] = json_number(r.subtracted);
  return json;
}

namespace {

/// One side's potential in words; empty where it is a map that was not checked.
std::string side_label(const std::shared_ptr<const MapRecipe>& recipe, const std::shared_ptr<const MapCheck>& check) {
  return recipe ? potential_label(*recipe) : check ? in_words(*check) : std::string();
}

bool has_vacuum(const CompareResult& result) {
  const auto is_one = [](const auto& recipe, const auto& check) {
    return (recipe && is_vacuum(*recipe)) || (check && check->is_vacuum());
  };
  return is_one(result.maps.source_recipe, result.maps.source_check) ||
         is_one(result.maps.target_recipe, result.maps.target_check);
}

Json check_json(const std::shared_ptr<const MapCheck>& check) {
  if (!check) return nullptr;
  Json json{{"kind", to_string(check->kind)},
            {"slope", json_number(check->best().slope)},
            {"correlation", json_number(check->best().correlation)},
            {"n_points", check->n_points},
            {"fits", Json::object()}};
  for (std::size_t k = 0; k < kReferenceKinds; ++k)
    json["fits"][to_string(static_cast<ReferenceKind>(k))] = {{"slope", json_number(check->fits[k].slope)},
                                                              {"correlation", json_number(check->fits[k].correlation)}};
  return json;
}

}  // namespace

std::string potential_label(const CompareResult& result) {
  const std::string source = side_label(result.maps.source_recipe, result.maps.source_check),
                    target = side_label(result.maps.target_recipe, result.maps.target_check);
  if (!result.maps.source_recipe && !result.maps.target_recipe && !has_vacuum(result)) return {};
  const std::string unknown = "a given map";
  return source == target ? source
                          : (source.empty() ? unknown : source) + " and " + (target.empty() ? unknown : target);
}

std::string potential_unit_text(const CompareResult& result) {
  return to_string(result.potential.unit) + (has_vacuum(result) ? kInVacuum : "");
}

Json given_maps_json(const CompareResult& result) {
  return {{"source", check_json(result.maps.source_check)}, {"target", check_json(result.maps.target_check)}};
}

Json potential_json(const CompareResult& result) {
  const auto &a = result.maps.source_recipe, &b = result.maps.target_recipe;
  if (!a && !b) return nullptr;
  Json json;
  json["label"] = potential_label(result);
  json["vacuum"] = has_vacuum(result);
  json["because"] = a ? a->because : b->because;
  json["zero"] = {{"source", a ? Json(to_string(a->zero)) : Json(nullptr)},
                  {"target", b ? Json(to_string(b->zero)) : Json(nullptr)}};
  json["notes"] = potential_notes(a.get(), b.get());
  return json;
}

}  // namespace espdiff
