// matrix_plan.cpp: makes, writes, reads and compares plans.
#include "matrix/matrix_plan.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/units.h"
#include "base/version.h"
#include "engine/engine.h"
#include "field/field_kinds.h"
#include "mapping/map_recipe.h"
#include "matrix/plan_difference.h"
#include "options/input_settings.h"
#include "options/options.h"
#include "options/settings.h"
#include "report/sections/field_json.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

std::string sha256_in(const MatrixPlan::Item& item, const std::string& role) {
  for (const InputFile& input : item.inputs) {
    if (input.role == role) return input.sha256;
  }
  return "";
}

}  // namespace

std::vector<std::string> MatrixPlan::parts() const { return part_names(settings); }
PartsAndFields MatrixPlan::compared() const { return {parts(), quantities_of(fields)}; }

MatrixPlan make_plan(const Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                     const std::string& potential, const std::string& radii_note) {
  constexpr std::size_t kMaxVariants = 10000;
  if (variants.size() < 2 || variants.size() > kMaxVariants)
    throw InputError("a matrix of " + std::to_string(variants.size()) + " variant" + (variants.size() == 1 ? "" : "s") +
                     " was asked for; 2 to " + std::to_string(kMaxVariants) + " can be compared");
  refuse_patches_of(options, "a matrix");
  MatrixPlan plan;
  plan.version = kVersion;
  plan.device = engine.back_end();
  plan.settings = setting_texts(options);
  plan.radii_note = radii_note;
  plan.fields = describe(make_fields(options.fields));
  if (variants.front().has_potential()) {
    plan.potential = potential;
    plan.potential_unit = to_string(variants.front().map ? variants.front().map->unit : PotentialUnit::kKtPerE);
    const bool vacuum = std::any_of(variants.begin(), variants.end(), [](const Variant& variant) {
      return std::any_of(variant.inputs.begin(), variant.inputs.end(),
                         [](const InputFile& input) { return input.computed && is_vacuum(*input.computed); });
    });
    if (vacuum) plan.potential_unit += kInVacuum;
  }
  std::vector<std::string> labels;
  for (const Variant& v : variants) {
    plan.variants.push_back({v.label, v.group, v.inputs});
    labels.push_back(v.label);
  }
  check_labels(labels);
  return plan;
}

Json plan_json(const MatrixPlan& plan) {
  Json json;
  json["version"] = plan.version;
  json["device"] = plan.device;
  json["potential"] = plan.potential;
  json["potential_unit"] = plan.potential_unit;
  json["radii_note"] = plan.radii_note;
  json["settings"] = Json::object();
  for (const auto& [name, value] : plan.settings) json["settings"][name] = value;
  json["variants"] = Json::array();
  for (const MatrixPlan::Item& item : plan.variants) {
    Json inputs = Json::array();
    for (const InputFile& input : item.inputs)
      inputs.push_back({{"role", input.role}, {"path", input.path}, {"sha256", input.sha256}});
    json["variants"].push_back({{"label", item.label}, {"group", item.group}, {"inputs", std::move(inputs)}});
  }
  if (!plan.fields.empty()) json["fields"] = fields_json(plan.fields);
  return json;
}

MatrixPlan parse_plan(const std::string& text) {
  const Json json = Json::parse(text);
  MatrixPlan plan;
  json.at("version").get_to(plan.version);
  json.at("device").get_to(plan.device);
  json.at("potential").get_to(plan.potential);
  json.at("potential_unit").get_to(plan.potential_unit);
  plan.radii_note = json.value("radii_note", "");
  for (const auto& [name, value] : json.at("settings").items()) plan.settings.emplace_back(name, value);
  for (const Json& item : json.at("variants")) {
    MatrixPlan::Item variant{item.at("label"), item.at("group"), {}};
    for (const Json& input : item.at("inputs"))
      variant.inputs.push_back({input.at("role"), input.at("path"), input.at("sha256")});
    plan.variants.push_back(std::move(variant));
  }
  if (json.contains("fields")) plan.fields = parse_fields_json(json["fields"]);
  return plan;
}

std::string plan_difference(const MatrixPlan& there, const MatrixPlan& here) {
  const std::string first = first_of({
      differ("the version", there.version, here.version),
      differ("the device", there.device, here.device),
      differ("the potential", there.potential, here.potential),
      differ("the unit", there.potential_unit, here.potential_unit),
      differ("the number of variants", std::to_string(there.variants.size()), std::to_string(here.variants.size())),
      differ("the number of settings", std::to_string(there.settings.size()), std::to_string(here.settings.size())),
  });
  if (!first.empty()) return first;
  for (std::size_t i = 0; i < here.settings.size(); ++i) {
    const std::string setting =
        first_of({differ("a setting's name", there.settings[i].first, here.settings[i].first),
                  differ("the setting " + here.settings[i].first, there.settings[i].second, here.settings[i].second)});
    if (!setting.empty()) return setting;
  }
  for (std::size_t f = 0; f < here.fields.size(); ++f) {  // as many: their names are a setting
    const FieldDescription &a = there.fields.at(f), &b = here.fields[f];
    for (std::size_t k = 0; k < b.files.size(); ++k) {
      if (a.files.size() != b.files.size() || a.files[k].sha256 != b.files[k].sha256)
        return "the file of the field " + b.quantity.name + " has changed";
    }
  }
  for (std::size_t i = 0; i < here.variants.size(); ++i) {
    const MatrixPlan::Item &a = there.variants[i], &b = here.variants[i];
    const std::string number = "variant " + std::to_string(i + 1);
    const std::string variant = first_of({differ("the label of " + number, a.label, b.label),
                                          differ("the number of inputs of " + b.label, std::to_string(a.inputs.size()),
                                                 std::to_string(b.inputs.size()))});
    if (!variant.empty()) return variant;
    for (const InputFile& input : b.inputs) {
      if (sha256_in(a, input.role) != input.sha256) return "the " + input.role + " of " + b.label + " has changed";
    }
  }
  return "";
}

}  // namespace espdiff
