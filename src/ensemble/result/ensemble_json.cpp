// ensemble_json.cpp: OUT.json of an ensemble.
#include "ensemble/result/ensemble_json.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/text/formats.h"
#include "base/version.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_result.h"
#include "report/compare_json.h"
#include "report/sections/json_number.h"
#include "report/sections/placement.h"
#include "statistics/permutations.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

Json options_json(const EnsembleOptions& options) {
  Json json;
  json["alpha"] = options.alpha;
  json["confidence"] = 1 - options.alpha;
  json["most_missing"] = options.most_missing;
  json["control"] = options.control == ErrorControl::kTfce ? "tfce" : "max-t";
  json["max_permutations"] = options.test.max_permutations;
  json["seed"] = options.test.seed;
  json["tfce"] = {{"extent_power", 0.5}, {"height_power", 2}, {"extent", "area"}};
  return json;
}

Json replicates_json(const EnsembleResult& result) {
  Json all = Json::array();
  for (const ReplicateSummary& r : result.replicates)
    all.push_back({{"group", r.group},
                   {"name", r.name},
                   {"n_frames", r.n_frames},
                   {"n_cut_off", r.n_cut_off},
                   {"n_failed", r.n_failed},
                   {"n_not_trustworthy", r.n_not_trustworthy},
                   {"median_inefficiency", json_number(r.inefficiency)},
                   {"median_effective_samples", json_number(r.effective)},
                   {"median_error_by_blocks_over_error", json_number(r.error_ratio)},
                   {"trend_share", json_number(r.drift.share)},
                   {"trend_p", json_number(r.drift.p)},
                   {"mean_potential", json_number(r.mean_potential)},
                   {"mean_rmsd_A", json_number(r.mean_rmsd_A)},
                   {"trusted_area_fraction", json_number(r.trusted_area_fraction)}});
  return all;
}

/// null without a number.
Json smallest(const std::vector<double>& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const double value : p) {
    if (value < least) least = value;
  }
  return json_number(least);
}

Json test_json(const EnsembleResult& result) {
  const SurfaceTest& test = result.test;
  Json json;
  const bool replicates = test.inference == Inference::kReplicates;
  json["inference"] = replicates ? "replicates" : "within runs";
  json["method"] = replicates ? "Welch's t of replicates; exchange of their labels"
                              : "Welch's t of blocks of frames; exchange of the blocks between the runs";
  json["n_permutations"] = test.n_permutations;
  json["exact"] = test.exact;
  json["smallest_p"] = test.n_permutations > 0 ? Json(test.smallest_p) : Json();
  if (!replicates)
    json["blocks"] = {{"n", test.blocks.n},
                      {"length", test.blocks.length},
                      {"gap", test.blocks.gap},
                      {"inefficiency", test.blocks.inefficiency},
                      {"least_frames", test.blocks.least_frames}};
  json["no_p_because"] = result.has_p() ? Json() : Json(result.why_no_p());
  json["mean_abs_difference"] = json_number(test.mean_abs_difference);
  json["mean_abs_difference_p"] = json_number(test.mean_abs_difference_p);
  json["mean_abs_difference_exchanged"] = json_number(test.mean_abs_difference_exchanged);
  json["significant_area_A2"] = result.significant_area_A2;
  json["significant_area_fraction"] = result.significant_area_A2 / result.tested_area_A2;
  json["smallest_p_max_t"] = smallest(test.p_max_t);
  json["smallest_p_tfce"] = smallest(test.p_tfce);
  return json;
}

Json noise_json(const EnsembleResult& result) {
  Json json = Json::object();
  for (std::size_t g = 0; g < result.groups.size(); ++g)
    json[result.groups[g].name] = {{"halves", json_number(result.noise.halves[g])},
                                   {"replicates", json_number(result.noise.replicates[g])}};
  if (result.compares) json["replicates_across_groups"] = json_number(result.noise.across);
  return json;
}

Json regression_json(const EnsembleFile& file, const EnsembleRegression& regression) {
  const SurfaceRegression& surface = regression.surface;
  Json json = {{"column", regression.column.name}, {"n_permutations", surface.n_permutations},
               {"exact", surface.exact},           {"smallest_p", surface.smallest_p},
               {"q2", json_number(surface.q2)},    {"q2_p", json_number(surface.q2_p)},
               {"replicates", Json::array()},      {"patches", Json::array()}};
  for (std::size_t r = 0; r < regression.column.values.size(); ++r)
    json["replicates"].push_back({{"group", file.plan().replicates[r].group},
                                  {"name", file.plan().replicates[r].name},
                                  {"value", json_number(regression.column.values[r])},
                                  {"predicted", json_number(surface.predicted[r])}});
  for (const EnsembleRegression::Patch& patch : regression.patches) {
    Json residues = Json::array();
    for (const auto& [residue, share] : patch.residues) residues.push_back({{"residue", residue}, {"share", share}});
    json["patches"].push_back({{"area_A2", patch.patch.area},
                               {"correlation", json_number(patch.correlation)},
                               {"slope", json_number(patch.slope)},
                               {"smallest_p", patch.smallest_p},
                               {"residues", std::move(residues)}});
  }
  return json;
}

Json patches_json(const EnsembleFile& file, const EnsembleResult& result) {
  Json all = Json::array();
  for (std::size_t k = 0; k < result.patches.size(); ++k) {
    const EnsemblePatch& patch = result.patches[k];
    const Vec3d& peak = file.surface().positions[patch.patch.peak];
    Json residues = Json::array();
    for (const auto& [residue, share] : patch.residues) residues.push_back({{"residue", residue}, {"share", share}});
    all.push_back({{"area_A2", patch.patch.area},
                   {"difference", json_number(result.patch_tests.difference[k])},
                   {"low", json_number(result.patch_tests.low[k])},
                   {"high", json_number(result.patch_tests.high[k])},
                   {"smallest_p", patch.smallest_p},
                   {"peak_A", {peak.x, peak.y, peak.z}},
                   {"residues", std::move(residues)}});
  }
  return all;
}

}  // namespace

Json ensemble_json(const EnsembleFile& file, const EnsembleResult& result) {
  Json json{{"format", kEnsembleFormat}, {"format_version", kFormatVersion}};
  json["version"] = kVersion;
  json["conclusion"] = result.conclusion;
  json["plan"] = Json::parse(plan_text(file.plan()));
  json["options"] = options_json(result.options);
  if (const auto& field = file.plan().field) {
    json["field"] = {
        {"name", field->quantity.name},  {"label", field->quantity.label},      {"kind", field->what},
        {"reference", field->reference}, {"signed", field->quantity.is_signed}, {"n_together", result.n_together}};
  }
  json["potential_unit"] = file.plan().potential_unit;
  json["n_vertices"] = file.n_vertices();
  json["area_A2"] = result.area_A2;
  json["tested_area_A2"] = result.tested_area_A2;
  json["tested_area_fraction"] = result.tested_share();
  json["replicates"] = replicates_json(result);
  // What a frame's `trustworthy` says nothing about.
  json["not_checked"] = {"round_trip", "residues"};
  if (result.compares) json["test"] = test_json(result);
  json["noise_floor"] = noise_json(result);
  for (std::size_t k = 0; k < result.fixed_patches.size(); ++k) {
    const FixedPatch& patch = result.fixed_patches[k];
    Json entry = {{"area_A2", patch.area_A2}, {"means", Json::object()}};
    for (std::size_t g = 0; g < result.groups.size(); ++g)
      entry["means"][result.groups[g].name] = json_number(patch.means[g]);
    if (result.compares) {
      const PlaceTests& t = result.fixed_patch_tests;
      entry["difference"] = json_number(t.difference[k]);
      entry["low"] = json_number(t.low[k]);
      entry["high"] = json_number(t.high[k]);
      entry["p"] = json_number(t.p[k]);
    }
    if (patch.placement != nullptr) entry["placement"] = placement_json(*patch.placement);
    json["fixed_patches"][patch.name] = std::move(entry);
  }
  if (!result.causes.empty()) json["causes"] = ensemble_causes_json(result);
  if (result.states) {
    json["states"] = {{"n", result.states->size()}, {"area_fraction", result.states->area_fraction}};
    json["states"]["component_shares"] = Json::array();
    for (const auto& component : result.states->components)
      json["states"]["component_shares"].push_back(json_number(component.share));
  }
  if (!result.template_checks.empty()) {
    json["template_check"] = Json::array();
    for (const TemplateCheck& check : result.template_checks) {
      Json differences = Json::array();
      for (const double difference : check.patch_differences) differences.push_back(json_number(difference));
      json["template_check"].push_back({{"template", check.template_name},
                                        {"mean_abs_difference", json_number(check.mean_abs_difference)},
                                        {"significant_area_A2", check.significant_area_A2},
                                        {"overlap", json_number(check.overlap)},
                                        {"patch_differences", std::move(differences)},
                                        {"largest_change", json_number(check.largest_change)}});
    }
  }
  if (result.compares) json["patches"] = patches_json(file, result);
  if (result.regression) json["regression"] = regression_json(file, *result.regression);
  json["equilibrium"] = {{"holds", result.not_equilibrium.empty()}, {"reasons", result.not_equilibrium}};
  // Too few frames for a trend.
  Json not_checked = Json::array();
  for (const ReplicateSummary& r : result.replicates) {
    if (!std::isfinite(r.drift.p)) not_checked.push_back({{"group", r.group}, {"name", r.name}});
  }
  json["equilibrium"]["not_checked"] = std::move(not_checked);
  json["warnings"] = result.warnings;
  return json;
}

}  // namespace espdiff
