// ensemble_plan.cpp: plans as JSON, compared and checked.
#include "ensemble/frames/ensemble_plan.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/formatted.h"
#include "io/text/json_integer.h"
#include "io/text/json_values.h"
#include "matrix/matrix_plan.h"
#include "matrix/plan_difference.h"
#include "report/sections/field_json.h"
#include "statistics/permutations.h"

namespace espdiff {
namespace {

using Json = nlohmann::ordered_json;

std::string label(const EnsembleReplicate& r) { return "replicate " + r.name + " of " + r.group; }

std::string replicates_differ(const EnsemblePlan& there, const EnsemblePlan& here) {
  std::string text = differ("the number of replicates", std::to_string(there.replicates.size()),
                            std::to_string(here.replicates.size()));
  for (std::size_t i = 0; i < here.replicates.size() && text.empty(); ++i) {
    const EnsembleReplicate &a = there.replicates[i], &b = here.replicates[i];
    const std::string number = " of replicate " + std::to_string(i + 1);
    text = differ("the group" + number, a.group, b.group);
    if (text.empty()) text = differ("the name" + number, a.name, b.name);
    if (text.empty())
      text = differ("the number of frames of " + label(b), std::to_string(a.n_frames), std::to_string(b.n_frames));
    if (text.empty() && a.sha256 != b.sha256) text = "the content of " + label(b) + " has changed";
    if (text.empty() && a.topology_sha256 != b.topology_sha256) text = "the topology of " + label(b) + " has changed";
  }
  return text;
}

Json sources_json(const FrameSources& s) {
  Json settings = Json::array();
  for (const auto& [name, text] : s.potential.given) settings.push_back({name, text});
  return {{"charges", s.charges},
          {"template", s.template_text},
          {"plugins", s.plugins},
          {"potential", s.potential.potential},
          {"cell", s.potential.cell},
          {"potential_settings", std::move(settings)},
          {"model", s.structure.model},
          {"include_hetero", s.structure.include_hetero},
          {"include_water", s.structure.include_water},
          {"assembly", s.structure.assembly}};
}

FrameSources parse_sources(const Json& json) {
  FrameSources s;
  json.at("charges").get_to(s.charges);
  json.at("template").get_to(s.template_text);
  json.at("plugins").get_to(s.plugins);
  json.at("potential").get_to(s.potential.potential);
  json.at("cell").get_to(s.potential.cell);
  json.at("potential_settings").get_to(s.potential.given);
  s.structure.model = integer_of<int>(json.at("model"));
  json.at("include_hetero").get_to(s.structure.include_hetero);
  json.at("include_water").get_to(s.structure.include_water);
  json.at("assembly").get_to(s.structure.assembly);
  return s;
}

std::string field_differs(const std::optional<FieldDescription>& there, const std::optional<FieldDescription>& here) {
  const std::string text = differ("the field", there ? there->what : "", here ? here->what : "");
  if (!text.empty() || !there || !here) return text;
  const auto same = [](const FieldFile& a, const FieldFile& b) { return a.sha256 == b.sha256; };
  return std::equal(there->files.begin(), there->files.end(), here->files.begin(), here->files.end(), same)
             ? ""
             : "the files of the field " + here->quantity.name + " have changed";
}

/// Whether sizes fit each other, and their sum is a number of frames.
bool holds_together(const EnsemblePlan& plan) {
  constexpr std::size_t kMostFrames = 1'000'000'000;
  std::size_t n = 0;
  for (const EnsembleReplicate& r : plan.replicates) {
    if (r.n_frames > kMostFrames || r.files.size() != r.sha256.size()) return false;
    n += r.n_frames;
  }
  return n <= kMostFrames && (plan.matrix == nullptr || plan.matrix->variants.size() == n);
}

}  // namespace

std::size_t EnsemblePlan::n_frames() const {
  std::size_t n = 0;
  for (const EnsembleReplicate& r : replicates) n += r.n_frames;
  return n;
}

std::vector<std::string> EnsemblePlan::groups() const {
  std::vector<std::string> names;
  for (const EnsembleReplicate& r : replicates) {
    if (std::find(names.begin(), names.end(), r.group) == names.end()) names.push_back(r.group);
  }
  return names;
}

std::vector<std::size_t> EnsemblePlan::replicates_of(const std::string& group) const {
  std::vector<std::size_t> found;
  for (std::size_t r = 0; r < replicates.size(); ++r) {
    if (replicates[r].group == group) found.push_back(r);
  }
  return found;
}

std::pair<std::size_t, std::size_t> EnsemblePlan::place_of(std::size_t frame) const {
  std::size_t replicate = 0;
  while (frame >= replicates.at(replicate).n_frames) frame -= replicates[replicate++].n_frames;
  return {replicate, frame};
}

std::string EnsemblePlan::name_of(std::size_t frame) const {
  if (matrix != nullptr) return matrix->variants.at(frame).label;
  const auto [replicate, number] = place_of(frame);
  return replicates[replicate].group + ", replicate " + replicates[replicate].name + ", frame " +
         std::to_string(number);
}

std::string plan_text(const EnsemblePlan& plan) {
  Json json;
  json["version"] = plan.version;
  json["device"] = plan.device;
  json["settings"] = Json::object();
  for (const auto& [name, value] : plan.settings) json["settings"][name] = value;
  json["potential"] = plan.potential;
  json["potential_unit"] = plan.potential_unit;
  json["template"] = {{"name", plan.template_name}, {"sha256", plan.template_sha256}};
  if (!plan.template_backbone.empty()) json["template"]["backbone"] = plan.template_backbone;
  json["charges"] = Json::object();
  for (const auto& [group, from] : plan.charges) json["charges"][group] = from;
  json["replicates"] = Json::array();
  for (const EnsembleReplicate& r : plan.replicates) {
    json["replicates"].push_back(
        {{"group", r.group}, {"name", r.name}, {"files", r.files}, {"sha256", r.sha256}, {"n_frames", r.n_frames}});
    if (r.topology.empty()) continue;
    json["replicates"].back()["topology"] = r.topology;
    json["replicates"].back()["topology_sha256"] = r.topology_sha256;
  }
  if (plan.sources) json["sources"] = sources_json(*plan.sources);
  json["residues"] = plan.residues;
  if (plan.matrix != nullptr) json["matrix"] = {{"plan", plan_json(*plan.matrix)}, {"exact_sample", plan.n_exact}};
  if (plan.field) {
    json["field"] = fields_json({*plan.field});
    json["n_fields"] = plan.n_fields;
  }
  // A path need not be UTF-8, JSON must be.
  return json.dump(1, ' ', false, Json::error_handler_t::replace);
}

EnsemblePlan parse_ensemble_plan(const std::string& text, const std::string& path) {
  const FormatError damaged(
      path, 0, "the description of the run in this file is damaged; " + switched_on("overwrite") + " begins anew");
  try {
    require_memory_for_json(text, path);
    const Json json = Json::parse(text);
    EnsemblePlan plan;
    json.at("version").get_to(plan.version);
    json.at("device").get_to(plan.device);
    for (const auto& [name, value] : json.at("settings").items()) plan.settings.emplace_back(name, value);
    json.at("potential").get_to(plan.potential);
    json.at("potential_unit").get_to(plan.potential_unit);
    json.at("template").at("name").get_to(plan.template_name);
    json.at("template").at("sha256").get_to(plan.template_sha256);
    plan.template_backbone = json.at("template").value("backbone", std::string());
    for (const auto& [group, from] : json.at("charges").items()) plan.charges.emplace_back(group, from);
    for (const Json& r : json.at("replicates"))
      plan.replicates.push_back({r.at("group"), r.at("name"), r.at("files").get<std::vector<std::string>>(),
                                 r.at("sha256").get<std::vector<std::string>>(),
                                 integer_of<std::size_t>(r.at("n_frames")), r.value("topology", std::string()),
                                 r.value("topology_sha256", std::string())});
    if (json.contains("sources")) plan.sources = parse_sources(json.at("sources"));
    json.at("residues").get_to(plan.residues);
    if (json.contains("matrix")) {
      plan.matrix = std::make_shared<const MatrixPlan>(parse_plan(json.at("matrix").at("plan").dump()));
      plan.n_exact = integer_of<std::size_t>(json.at("matrix").at("exact_sample"));
    }
    if (json.contains("field")) {
      plan.field = parse_fields_json(json.at("field")).at(0);
      plan.n_fields = integer_of<std::size_t>(json.at("n_fields"));
    }
    if (!holds_together(plan)) throw damaged;
    return plan;
  } catch (const Json::exception&) {
    throw damaged;
  } catch (const std::out_of_range&) {
    throw damaged;
  }
}

std::string plan_difference(const EnsemblePlan& there, const EnsemblePlan& here) {
  const auto kind = [](const EnsemblePlan& plan) { return plan.matrix == nullptr ? "an ensemble" : "a matrix"; };
  std::string text = differ("the run", kind(there), kind(here));
  if (text.empty() && here.matrix != nullptr) text = plan_difference(*there.matrix, *here.matrix);
  if (text.empty()) text = differ("the version", there.version, here.version);
  if (text.empty()) text = differ("the device", there.device, here.device);
  if (text.empty()) text = differ("the potential", there.potential, here.potential);
  if (text.empty()) text = differ("the unit", there.potential_unit, here.potential_unit);
  const std::map<std::string, std::string> settings(there.settings.begin(), there.settings.end());
  for (const auto& [name, value] : here.settings) {
    const auto found = settings.find(name);
    if (text.empty()) text = differ("the setting " + name, found == settings.end() ? "" : found->second, value);
  }
  if (text.empty()) text = field_differs(there.field, here.field);
  if (text.empty()) text = replicates_differ(there, here);
  if (text.empty() && there.template_sha256 != here.template_sha256)
    text = "the template is " + there.template_name + " there and " + here.template_name + " here";
  if (text.empty() && there.charges != here.charges) text = "the charges of a group have changed";
  return text;
}

void check_replicates(const std::vector<EnsembleReplicate>& replicates) {
  EnsemblePlan plan;
  plan.replicates = replicates;
  const std::vector<std::string> groups = plan.groups();
  if (groups.empty()) throw InputError("no group was given; name one or two by " + option("group"));
  if (groups.size() > 2)
    throw InputError("there are " + std::to_string(groups.size()) + " groups (" + groups[0] + ", " + groups[1] + ", " +
                     groups[2] + (groups.size() > 3 ? ", ...)" : ")") +
                     "; two are compared at a time, and one is described alone");
  const bool is_pair = replicates.size() == 2 && replicates[0].n_frames < 2 && replicates[1].n_frames < 2;
  std::map<std::string, std::string> seen;
  for (std::size_t i = 0; i < replicates.size(); ++i) {
    const EnsembleReplicate& r = replicates[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (replicates[j].group == r.group && replicates[j].name == r.name)
        throw InputError("group " + r.group + " has two replicates named " + r.name + "; name them apart");
    }
    for (std::size_t k = 0; k < r.files.size(); ++k) {
      const auto [entry, is_new] = seen.emplace(r.sha256[k], label(r) + " (" + r.files[k] + ")");
      if (!is_new)
        throw InputError(r.files[k] + " of " + label(r) + " has the same content as " + entry->second +
                         "; a replicate counts once");
    }
    if (r.n_frames < 2)
      throw InputError(label(r) + " has " + std::to_string(r.n_frames) + " frame" + (r.n_frames == 1 ? "" : "s") +
                       "; a replicate needs two or more" +
                       (is_pair ? ", and two single structures are a pair for `espdiff compare`" : ""));
  }
}

std::string design_warning(const EnsemblePlan& plan) {
  const std::vector<std::string> groups = plan.groups();
  if (groups.size() < 2) return "";
  const std::size_t a = plan.replicates_of(groups[0]).size(), b = plan.replicates_of(groups[1]).size();
  if (std::min(a, b) < 2)
    return "a group has one replicate: p-values and intervals will be of these runs only (blocks of frames are "
           "exchanged between them), not of the states; four replicates or more of each state allow more";
  const double p = smallest_p(a, b);
  if (p < 0.05) return "";
  return formatted(
      "%zu against %zu replicates can be exchanged in %llu ways: no family-wise p can be below %.3g, whatever "
      "the frames are; 4 against 4 reach 0.029",
      a, b, static_cast<unsigned long long>(count_permutations(a, b)), p);
}

}  // namespace espdiff
