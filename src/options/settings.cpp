// settings.cpp: the table of a comparison's settings.
#include "options/settings.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "align/geometry/rigid_domains.h"
#include "align/pair_atoms.h"
#include "base/error.h"
#include "field/field_kinds.h"
#include "field/field_patches.h"
#include "field/interface_request.h"
#include "field/patches_request.h"
#include "options/cause_settings.h"
#include "options/input_settings.h"
#include "options/options.h"

namespace espdiff {
namespace {

using Rows = RowsOf<CompareOptions>;

/// Headings of settings that only one method reads.
constexpr const char* kMorphGroup = "Mapping by morph";
constexpr const char* kDeformGroup = "Mapping by deform";

void add_surface_settings(std::vector<Setting>& all) {
  const std::string group = "Surface";
  all.push_back(of_surface(Rows::number(
      "grid-spacing", group, {0.001, 20}, [](auto& o) -> auto& { return o.surface.grid_spacing_A; },
      "Lattice spacing of the density, Angstrom")));
  all.push_back(of_surface(Rows::number(
      "radius-scale", group, {0.01, 20}, [](auto& o) -> auto& { return o.surface.radius_scale; },
      "Width of each atom's Gaussian in units of its radius")));
  all.push_back(of_surface(Rows::number(
      "isovalue", group, {1e-6, 1e6}, [](auto& o) -> auto& { return o.surface.isovalue; },
      "Density at which the surface lies; higher is tighter")));
  all.push_back(of_surface(Rows::boolean(
      "cavities", group, [](auto& o) -> auto& { return o.surface.cavities; },
      "Keep closed cavities; they are removed and counted by default")));
  all.push_back(of_surface(Rows::boolean(
      "project", group, [](auto& o) -> auto& { return o.surface.project; },
      "Project vertices onto the exact isosurface")));
}

/// `prefix` is "" for the mapping and "regularize-" for the regularization.
template <typename Iteration, typename Displacement>
void add_iteration_settings(std::vector<Setting>& all, const std::string& prefix, const std::string& group,
                            Iteration iteration, Displacement min_displacement) {
  const auto add = [&](const char* name, NumberRange range, double DeformOptions::*member, const char* help) {
    all.push_back(Rows::number(
        prefix + name, group, range, [ iteration, member ](auto& o) -> auto& { return iteration(o).*member; }, help));
  };
  add("sigma", {1e-6, 1000}, &DeformOptions::sigma, "Step scale");
  add("mu", kShare, &DeformOptions::mu, "Weight of the external force against the internal one");
  add("rho", kShare, &DeformOptions::rho, "Weight of rigidity against tension");
  add("tangential-gain", kNotNegative, &DeformOptions::tangential_gain,
      "Multiplies the internal force, which moves vertices along the surface");
  all.push_back(Rows::count(
      prefix + "max-iterations", group, {0, 1e6}, [iteration](auto& o) -> auto& { return iteration(o).max_iterations; },
      "Maximum number of iterations"));
  all.push_back(
      Rows::number(prefix + "min-displacement", group, kNotNegative, min_displacement,
                   "Converged when the mean displacement of an iteration falls below this many grid spacings"));
}

void add_morph_settings(std::vector<Setting>& all) {
  all.push_back(Rows::number(
      "max-step", kMorphGroup, {0.001, 1000}, [](auto& o) -> auto& { return o.morph.max_step_A; },
      "Maximum movement of an atom per step, Angstrom"));
  all.push_back(Rows::number(
      "max-edge", kMorphGroup, {0.25, 1000}, [](auto& o) -> auto& { return o.morph_max_edge; },
      "Split edges longer than this many grid spacings"));
  all.push_back(Rows::number(
      "max-stretch", kMorphGroup, {1, HUGE_VAL, true}, [](auto& o) -> auto& { return o.morph.max_stretch; },
      "Stretch of an edge at which the surface counts as torn"));
}

void add_mapping_settings(std::vector<Setting>& all) {
  const std::string group = "Mapping";
  all.push_back(Rows::choice(
      "method", group, {"morph", "deform"},
      [](CompareOptions& o, const std::string& text) { o.method = parse_method(text); },
      [](const CompareOptions& o) { return to_string(o.method); },
      "Mapping method: follow the moving atoms (morph), or forces in a field (deform)"));
  all.push_back(Rows::boolean(
      "round-trip", group, [](auto& o) -> auto& { return o.round_trip; },
      "Also map back and report the round-trip error; doubles the time"));
  add_morph_settings(all);
  all.push_back(Rows::choice(
      "deform-field", kDeformGroup, {"density", "distance", "gvf", "gvf2"},
      [](CompareOptions& o, const std::string& text) { o.field = parse_deform_field(text); },
      [](const CompareOptions& o) { return to_string(o.field); },
      "Field that moves the surface: density, distance (far from the target), or gradient vector flow of the target "
      "(gvf) or of both surfaces (gvf2)"));
  all.back().file_key = "field";
  all.push_back(Rows::number(
      "distance-threshold", kDeformGroup, {0, 1000}, [](auto& o) -> auto& { return o.distance_threshold_A; },
      "Distance beyond which the distance field is used, Angstrom"));
  all.push_back(Rows::number(
      "gvf-weight", kDeformGroup, {1e-6, 1e6}, [](auto& o) -> auto& { return o.flow.weight_A2; },
      "Weight of smoothness in the gradient vector flow (mu), Angstrom^2"));
  all.push_back(Rows::number(
      "gvf-tolerance", kDeformGroup, {1e-12, 1000}, [](auto& o) -> auto& { return o.flow.tolerance; },
      "Converged when a sweep changes no vector by more than this; vectors at the surface have length 1"));
  all.push_back(Rows::count(
      "gvf-max-sweeps", kDeformGroup, {1, 1e6}, [](auto& o) -> auto& { return o.flow.max_sweeps; },
      "Maximum number of sweeps"));
  all.push_back(Rows::choice(
      "interpolation", kDeformGroup, {"trilinear", "tricubic"},
      [](CompareOptions& o, const std::string& text) {
        o.deform.interpolation = o.regularize.interpolation = parse_interpolation(text);
      },
      [](const CompareOptions& o) {
        return o.deform.interpolation == Interpolation::kTricubic ? "tricubic" : "trilinear";
      },
      "Interpolation of the field"));
  all.push_back(Rows::choice(
      "rest-shape", kDeformGroup, {"source", "none"},
      [](CompareOptions& o, const std::string& text) { o.deform.rest_shape = text == "source"; },
      [](const CompareOptions& o) { return o.deform.rest_shape ? "source" : "none"; },
      "Shape that the internal force restores: the source's, or none (equal edges)"));
  all.push_back(Rows::boolean(
      "subdivide", kDeformGroup, [](auto& o) -> auto& { return o.subdivide; },
      "Split stretched edges and iterate again, which reaches into crevices"));
  add_iteration_settings(
      all, "", kDeformGroup, [](auto& o) -> auto& { return o.deform; },
      [](auto& o) -> auto& { return o.deform_min_displacement; });
  all.push_back(of_surface(Rows::parsed(
      kThesisSetting, kDeformGroup,
      [](CompareOptions&, const std::string& text) {
        if (text != "0" && text != "1") refuse_value(kThesisSetting, text, "0 or 1");
      },
      [](const CompareOptions&) { return "0"; },
      "The thesis' original iteration: tangential gains 1, rest shape none, smallest displacements 0.001, "
      "cavities, no projection. Other settings given still apply")));
  all.back().kind = SettingKind::kBoolean;
}

/// Distances of 0 to 20 A, each once: "0" or "0,1.4,3".
std::vector<double> parse_offsets(const std::string& name, const std::string& text) {
  constexpr double kMost_A = 20;
  const std::string accepted = "a distance of 0 to 20 Angstrom, or a list of some such as 0,1.4,3";
  std::vector<double> offsets;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, ',');) {
    double value = 0;
    if (!read_value(part, value) || !std::isfinite(value) || value < 0 || value > kMost_A)
      refuse_value(name, text, accepted);
    if (std::find(offsets.begin(), offsets.end(), value) != offsets.end())
      refuse_value(name, text, accepted + ", each once");
    offsets.push_back(value);
  }
  if (offsets.empty() || text.back() == ',') refuse_value(name, text, accepted);
  return offsets;
}

Setting offset_setting() {
  Setting offset = Rows::parsed(
      "offset", "Potentials",
      [](CompareOptions& o, const std::string& text) { o.offsets_A = parse_offsets("offset", text); },
      [](const CompareOptions& o) {
        std::string text;
        for (const double value : o.offsets_A) text += (text.empty() ? "" : ",") + written_value(value);
        return text;
      },
      "Distance outside both surfaces, along their normals, at which the potentials are read, Angstrom; a list "
      "such as 0,1.4,3 gives the metrics at each, and vertices and residues have the first");
  return offset;
}

/// A list of named fields; setting it again adds to it.
Setting field_setting() {
  Setting row = Rows::parsed(
      "field", "Fields",
      [](CompareOptions& o, const std::string& text) {
        if (text.empty()) return;  // the default: none
        for (FieldRequest& request : parse_fields(text)) o.fields.push_back(std::move(request));
      },
      [](const CompareOptions& o) {
        std::string text;
        for (const FieldRequest& request : o.fields)
          text += (text.empty() ? "" : "|") + request.name + "=" + request.what;
        return text;
      },
      "Compare another quantity of the surfaces, too, such as hydrophobicity or b-factor: NAME, or NAME=KIND and "
      "NAME=KIND:ARGUMENT under a name of one's own; `fields` lists the kinds. Several may be given");
  row.is_list = row.is_named = true;
  row.file_key = "fields";
  return row;
}

/// A list of fields with thresholds; setting it again adds to it.
Setting patches_of_setting() {
  Setting row = Rows::parsed(
      "patches-of", "Fields",
      [](CompareOptions& o, const std::string& text) {
        for (PatchesRequest& request : parse_patches_of(text)) o.patches_of.push_back(std::move(request));
      },
      [](const CompareOptions& o) {
        std::string text;
        for (const PatchesRequest& request : o.patches_of) text += (text.empty() ? "" : ",") + to_string(request);
        return text;
      },
      "Find the connected areas of each state beyond a threshold of a field, and what became of each in the other "
      "state: FIELD>T, FIELD<T or FIELD>T<U (quoted in a shell); potential alone means potential>1<-1. Several may be "
      "given");
  row.is_list = true;
  return row;
}

Setting interface_setting() {
  return Rows::parsed(
      "interface", "Fields",
      [](CompareOptions& o, const std::string& text) {
        if (!text.empty()) parse_interface(text);
        o.interface = text;
      },
      [](const CompareOptions& o) { return o.interface; },
      "Compare the electrostatic complementarity of two partners of a complex, A:B: chains, as in H,L:A, or "
      "selections. Both states are complexes; the surface that is compared is that of the first partner alone");
}

/// The settings whose key in OUT.json ends with a unit.
constexpr std::pair<const char*, const char*> kUnits[] = {{"grid-spacing", "A"},       {"max-step", "A"},
                                                          {"distance-threshold", "A"}, {"gvf-weight", "A2"},
                                                          {"temperature", "K"},        {"region-within", "A"}};

std::vector<Setting> make_settings() {
  std::vector<Setting> all;
  all.push_back(Rows::choice(
      "align", "Molecules", {"all", "backbone", "ca", "none"},
      [](CompareOptions& o, const std::string& text) { o.align = parse_align_atoms(text); },
      [](const CompareOptions& o) { return to_string(o.align); },
      "Paired atoms to superpose; none compares the molecules as given"));
  Setting domains = Rows::parsed(
      "domains", "Molecules",
      [](CompareOptions& o, const std::string& text) {
        check_domains(text);
        o.domains = text;
      },
      [](const CompareOptions& o) { return o.domains; },
      "Motions that the mapping follows: none superposes the whole; with local, each residue follows the "
      "motion of its neighbourhood (morph only); as-needed maps with local once more where the mapping "
      "with none slips, and keeps the better one. Rigid domains, each superposed by itself: chains, auto "
      "(found by a search), or the source's residues, such as A:1-29,68-117/A:30-67");
  all.push_back(domains);
  add_input_settings(all);
  all.push_back(field_setting());
  all.push_back(patches_of_setting());
  all.push_back(interface_setting());
  all.push_back(offset_setting());
  all.push_back(of_surface(Rows::number(
      "temperature", "Potentials", {1, 1e5}, [](auto& o) -> auto& { return o.temperature_K; },
      "Temperature of kT in potentials and units, K")));
  all.push_back(Rows::boolean(
      "trust-maps", "Potentials", [](auto& o) -> auto& { return o.trust_maps; },
      "Take given maps as they are: maps that do not fit the molecules' charges, or a potential in vacuum against one "
      "in water, give warnings and are not refused"));
  all.push_back(Rows::number(
      "require", "Verdict", {0, 1, true}, [](auto& o) -> auto& { return o.required_share; },
      "Share of the source's surface, and of the target's, that has to be trusted; with less a result is NOT "
      "TRUSTWORTHY. Use 0.95 for an answer of yes or no"));
  all.push_back(Rows::boolean(
      "leave-out-turned", "Verdict", [](auto& o) -> auto& { return o.leave_out_turned; },
      "Do not trust side chains that turned about their bonds where the mapping puts a point farther than 3 A, instead "
      "of 8 A, from where its atoms went: there the residue is right, but not its face. Of NMR models half of the "
      "surface is left"));
  add_surface_settings(all);
  add_mapping_settings(all);
  const std::size_t first = all.size();
  add_iteration_settings(
      all, "regularize-", "Regularization", [](auto& o) -> auto& { return o.regularize; },
      [](auto& o) -> auto& { return o.regularize_min_displacement; });
  for (std::size_t i = first; i < all.size(); ++i) all[i].of_surface = true;
  for (Setting& setting : all) {
    for (const auto& [name, unit] : kUnits)
      if (setting.name == name) setting.unit = unit;
  }
  return all;
}

}  // namespace

Setting of_surface(Setting row) {
  row.of_surface = true;
  return row;
}

std::string Setting::key() const {
  if (!file_key.empty()) return file_key;
  std::string key = unit.empty() ? name : name + "_" + unit;
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = make_settings();
  return all;
}

std::vector<std::pair<std::string, std::string>> setting_texts(const CompareOptions& options) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const Setting& setting : settings()) texts.emplace_back(setting.name, setting.get(options));
  return texts;
}

void refuse_patches_of(const CompareOptions& options, const std::string& what) {
  if (!options.patches_of.empty())
    throw InputError(option("patches-of") + ": " + what + " has no patches of one state; compare pairs by them");
}

const Setting& find_setting(const std::string& name) {
  for (const Setting& setting : settings()) {
    if (setting.name == name) return setting;
  }
  for (const RenamedSetting& renamed : renamed_settings()) {
    if (renamed.old_name == name) throw InputError(option(name) + " is called " + option(renamed.name) + " now");
  }
  throw InputError("there is no setting '" + name + "'");
}

const std::vector<RenamedSetting>& renamed_settings() {
  static const std::vector<RenamedSetting> all{{"pieces", "domains"}};
  return all;
}

namespace {

/// Refuses settings that the chosen method would ignore.
void refuse_of_other_method(const std::vector<std::pair<std::string, std::string>>& given, Method method) {
  const std::string other = method == Method::kMorph ? kDeformGroup : kMorphGroup;
  for (const auto& [name, text] : given) {
    const Setting& setting = find_setting(name);
    if (setting.group != other || (name == kThesisSetting && text == "0")) continue;
    const std::string its_method = method == Method::kMorph ? "deform" : "morph";
    throw InputError(option(name) + " is a setting of the method " + its_method + ", and the method is " +
                     to_string(method) + "; give " + option("method", its_method) + " as well, or leave " +
                     option(name) + " out");
  }
}

/// The field that an interface is compared by, unless it is among them.
void add_complementarity(std::vector<FieldRequest>& fields) {
  const bool is_there = std::any_of(fields.begin(), fields.end(),
                                    [](const FieldRequest& request) { return request.what == kComplementarity; });
  if (!is_there) fields.push_back({kComplementarity, kComplementarity});
}

}  // namespace

CompareOptions make_options(const std::vector<std::pair<std::string, std::string>>& given) {
  const bool thesis = std::any_of(given.begin(), given.end(), [](const auto& setting) {
    return setting.first == kThesisSetting && setting.second == "1";
  });
  CompareOptions options = thesis ? thesis_options() : CompareOptions{};
  for (const auto& [name, text] : given) find_setting(name).set(options, text);
  refuse_of_other_method(given, options.method);
  check_input_options(options.input);
  if (!options.interface.empty()) add_complementarity(options.fields);
  check_fields(options.fields, part_names(options.input));
  check_patches_of(options.patches_of, options.fields);
  check_readings(options);
  return options;
}

}  // namespace espdiff
