// settings.cpp: the table of a comparison's settings.
#include "pipeline/settings.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <locale>
#include <sstream>

#include "base/error.h"

namespace espdiff {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& text, const std::string& accepted) {
  throw InputError(name + ": '" + text + "' is not " + accepted);
}

/// A number in the C locale, whatever the program that hosts us has set.
template <typename Number>
bool parse(const std::string& text, Number& value) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  return static_cast<bool>(in >> value) && (in >> std::ws).eof();
}

template <typename Number>
std::string written(Number value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << value;
  return out.str();
}

/// Which numbers a setting accepts.
struct Range {
  double low;
  bool low_included;
  const char* words;
};
constexpr Range kPositive{0, false, "a positive number"}, kNotNegative{0, true, "a number of 0 or more"},
    kAnyNumber{-HUGE_VAL, false, "a number"}, kCount{0, true, "a whole number of 0 or more"};

bool within(const Range& range, double value) {
  return std::isfinite(value) && (range.low_included ? value >= range.low : value > range.low);
}

/// Headings of what only one of the methods reads.
constexpr const char* kMorphGroup = "Mapping by morph";
constexpr const char* kDeformGroup = "Mapping by deform";

/// A setting that is a number; `at` finds it in the options.
template <typename At>
Setting number(const std::string& name, const std::string& group, Range range, At at, const std::string& help) {
  Setting s{name, group, SettingKind::kNumber, {}, help, false, nullptr, nullptr};
  s.set = [name, range, at](CompareOptions& o, const std::string& text) {
    double value = 0;
    if (!parse(text, value) || !within(range, value)) refuse(name, text, range.words);
    at(o) = value;
  };
  s.get = [at](const CompareOptions& o) { return written(at(o)); };
  return s;
}

template <typename At>
Setting count(const std::string& name, const std::string& group, At at, const std::string& help) {
  Setting s{name, group, SettingKind::kInteger, {}, help, false, nullptr, nullptr};
  s.set = [name, at](CompareOptions& o, const std::string& text) {
    int value = 0;
    if (!parse(text, value) || value < 0) refuse(name, text, kCount.words);
    at(o) = value;
  };
  s.get = [at](const CompareOptions& o) { return written(at(o)); };
  return s;
}

template <typename At>
Setting boolean(const std::string& name, const std::string& group, At at, const std::string& help) {
  Setting s{name, group, SettingKind::kBoolean, {}, help, false, nullptr, nullptr};
  s.set = [name, at](CompareOptions& o, const std::string& text) {
    if (text != "0" && text != "1") refuse(name, text, "0 or 1");
    at(o) = text == "1";
  };
  s.get = [at](const CompareOptions& o) { return at(o) ? "1" : "0"; };
  return s;
}

/// A setting with named values.
template <typename Set, typename Get>
Setting choice(const std::string& name, const std::string& group, std::vector<std::string> choices, Set set, Get get,
               const std::string& help) {
  std::string list;
  for (std::size_t i = 0; i < choices.size(); ++i)
    list += (i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ") + choices[i];
  Setting s{name, group, SettingKind::kChoice, choices, help, false, nullptr, get};
  s.set = [=](CompareOptions& o, const std::string& text) {
    if (std::find(choices.begin(), choices.end(), text) == choices.end()) refuse(name, text, list);
    set(o, text);
  };
  return s;
}

Setting of_surface(Setting s) {
  s.of_surface = true;
  return s;
}

void add_surface_settings(std::vector<Setting>& all) {
  const std::string group = "Surface";
  all.push_back(of_surface(number(
      "grid-spacing", group, kPositive, [](auto& o) -> auto& { return o.surface.grid_spacing_A; },
      "Lattice spacing of the density, Angstrom")));
  all.push_back(of_surface(number(
      "radius-scale", group, kPositive, [](auto& o) -> auto& { return o.surface.radius_scale; },
      "Width of each atom's Gaussian in units of its radius")));
  all.push_back(of_surface(number(
      "isovalue", group, kPositive, [](auto& o) -> auto& { return o.surface.isovalue; },
      "Density at which the surface lies; higher is tighter")));
  all.push_back(of_surface(boolean(
      "cavities", group, [](auto& o) -> auto& { return o.surface.cavities; },
      "Keep closed cavities; they are counted and left out else")));
  all.push_back(of_surface(boolean(
      "project", group, [](auto& o) -> auto& { return o.surface.project; },
      "Vertices on the exact isosurface, instead of where the lattice puts them")));
}

/// `prefix` is "" for the mapping and "regularize-" for the regularization.
template <typename Iteration, typename Displacement>
void add_iteration_settings(std::vector<Setting>& all, const std::string& prefix, const std::string& group,
                            Iteration iteration, Displacement min_displacement) {
  const auto add = [&](const char* name, Range range, double DeformOptions::*member, const char* help) {
    all.push_back(number(
        prefix + name, group, range, [ iteration, member ](auto& o) -> auto& { return iteration(o).*member; }, help));
  };
  add("sigma", kPositive, &DeformOptions::sigma, "Step scale");
  add("mu", kAnyNumber, &DeformOptions::mu, "Weight of the external against the internal force, 0 to 1");
  add("rho", kAnyNumber, &DeformOptions::rho, "Rigidity against tension, 0 to 1");
  add("tangential-gain", kNotNegative, &DeformOptions::tangential_gain,
      "Multiplies the internal force, which moves vertices along the surface");
  all.push_back(count(
      prefix + "max-iterations", group, [iteration](auto& o) -> auto& { return iteration(o).max_iterations; },
      "Iterations at most"));
  all.push_back(number(prefix + "min-displacement", group, kNotNegative, min_displacement,
                       "Converged when the mean displacement of an iteration falls below this many grid spacings"));
}

void add_morph_settings(std::vector<Setting>& all) {
  all.push_back(number(
      "max-step", kMorphGroup, Range{0.001, true, "a number of 0.001 or more"},
      [](auto& o) -> auto& { return o.morph.max_step_A; }, "Farthest that an atom moves in one step, Angstrom"));
  all.push_back(number(
      "max-edge", kMorphGroup, kPositive, [](auto& o) -> auto& { return o.morph_max_edge; },
      "Edges longer than so many grid spacings are halved"));
  all.push_back(number(
      "max-stretch", kMorphGroup, Range{1, false, "a number above 1"},
      [](auto& o) -> auto& { return o.morph.max_stretch; },
      "Where such an edge has grown so many times the surface counts as torn"));
}

void add_mapping_settings(std::vector<Setting>& all) {
  const std::string group = "Mapping";
  all.push_back(choice(
      "method", group, {"morph", "deform"},
      [](CompareOptions& o, const std::string& text) { o.method = parse_method(text); },
      [](const CompareOptions& o) { return to_string(o.method); },
      "How the surface is mapped: carried by the moving atoms (morph), or drawn by a field (deform)"));
  all.push_back(boolean(
      "round-trip", group, [](auto& o) -> auto& { return o.round_trip; },
      "Map back as well, which takes as long again, and report how far from the start that ends"));
  add_morph_settings(all);
  all.push_back(choice(
      "field", kDeformGroup, {"density", "distance", "gvf", "gvf2"},
      [](CompareOptions& o, const std::string& text) { o.field = parse_field_kind(text); },
      [](const CompareOptions& o) { return to_string(o.field); },
      "What draws the surface: density, the distance where it is far, or gradient vector flow from the target (gvf) or "
      "from both surfaces (gvf2)"));
  all.push_back(number(
      "distance-threshold", kDeformGroup, kNotNegative, [](auto& o) -> auto& { return o.distance_threshold_A; },
      "Distance beyond which the distance field draws, Angstrom"));
  all.push_back(number(
      "gvf-weight", kDeformGroup, kPositive, [](auto& o) -> auto& { return o.flow.weight_A2; },
      "Smoothness of the gradient vector flow against the normals at the surface (mu), Angstrom^2"));
  all.push_back(number(
      "gvf-tolerance", kDeformGroup, kPositive, [](auto& o) -> auto& { return o.flow.tolerance; },
      "The flow is converged when a sweep would move none of its vectors by more; they are 1 long at the surface"));
  all.push_back(count(
      "gvf-max-sweeps", kDeformGroup, [](auto& o) -> auto& { return o.flow.max_sweeps; },
      "Sweeps of the flow at most; 1 or more"));
  all.push_back(choice(
      "interpolation", kDeformGroup, {"trilinear", "tricubic"},
      [](CompareOptions& o, const std::string& text) {
        o.deform.interpolation = o.regularize.interpolation = parse_interpolation(text);
      },
      [](const CompareOptions& o) {
        return o.deform.interpolation == Interpolation::kTricubic ? "tricubic" : "trilinear";
      },
      "Sampling of the field"));
  all.push_back(choice(
      "rest-shape", kDeformGroup, {"source", "none"},
      [](CompareOptions& o, const std::string& text) { o.deform.rest_shape = text == "source"; },
      [](const CompareOptions& o) { return o.deform.rest_shape ? "source" : "none"; },
      "What the internal force restores: the source's shape, or none but equal edges"));
  all.push_back(boolean(
      "subdivide", kDeformGroup, [](auto& o) -> auto& { return o.subdivide; },
      "Halve edges that have been stretched and go on, so that crevices are reached"));
  add_iteration_settings(
      all, "", kDeformGroup, [](auto& o) -> auto& { return o.deform; },
      [](auto& o) -> auto& { return o.deform_min_displacement; });
  Setting thesis{
      kThesisSetting,
      kDeformGroup,
      SettingKind::kBoolean,
      {},
      "The thesis' iteration as it stands: tangential gains 1, rest shape none, smallest displacements 0.001, "
      "cavities, no projection. Settings given beside it still count",
      true,
      nullptr,
      nullptr};
  thesis.set = [](CompareOptions&, const std::string& text) {
    if (text != "0" && text != "1") refuse(kThesisSetting, text, "0 or 1");
  };
  thesis.get = [](const CompareOptions&) { return "0"; };
  all.push_back(thesis);
}

std::vector<Setting> make_settings() {
  std::vector<Setting> all;
  all.push_back(choice(
      "align", "Molecules", {"all", "backbone", "ca", "none"},
      [](CompareOptions& o, const std::string& text) { o.align = parse_align_atoms(text); },
      [](const CompareOptions& o) { return to_string(o.align); },
      "Paired atoms that are superposed; none compares as given"));
  Setting pieces{"pieces",
                 "Molecules",
                 SettingKind::kText,
                 {},
                 "Rigid pieces that are aligned by themselves before the mapping: none, chains, domains (found by a "
                 "search), or the "
                 "source's residues, such as A:1-29,68-117/A:30-67",
                 false,
                 nullptr,
                 nullptr};
  pieces.set = [](CompareOptions& o, const std::string& text) {
    check_pieces(text);
    o.pieces = text;
  };
  pieces.get = [](const CompareOptions& o) { return o.pieces; };
  all.push_back(pieces);
  all.push_back(number(
      "temperature", "Potentials", kPositive, [](auto& o) -> auto& { return o.temperature_K; },
      "Temperature for converting between kT/e and other units, K"));
  add_surface_settings(all);
  add_mapping_settings(all);
  const std::size_t first = all.size();
  add_iteration_settings(
      all, "regularize-", "Regularization", [](auto& o) -> auto& { return o.regularize; },
      [](auto& o) -> auto& { return o.regularize_min_displacement; });
  for (std::size_t i = first; i < all.size(); ++i) all[i].of_surface = true;
  return all;
}

}  // namespace

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = make_settings();
  return all;
}

const Setting& find_setting(const std::string& name) {
  for (const Setting& setting : settings()) {
    if (setting.name == name) return setting;
  }
  throw InputError("there is no setting '" + name + "'");
}

namespace {

/// A setting that the method does not read would be ignored in silence.
void refuse_of_other_method(const std::vector<std::pair<std::string, std::string>>& given, Method method) {
  const std::string other = method == Method::kMorph ? kDeformGroup : kMorphGroup;
  for (const auto& [name, text] : given) {
    const Setting& setting = find_setting(name);
    if (setting.group != other || (name == kThesisSetting && text == "0")) continue;
    throw InputError(name + " is a setting of the method " + (method == Method::kMorph ? "deform" : "morph") +
                     ", and the method is " + to_string(method) + "; give method " +
                     (method == Method::kMorph ? "deform" : "morph") + " as well, or leave " + name + " out");
  }
}

}  // namespace

CompareOptions make_options(const std::vector<std::pair<std::string, std::string>>& given) {
  const bool thesis = std::any_of(given.begin(), given.end(), [](const auto& setting) {
    return setting.first == kThesisSetting && setting.second == "1";
  });
  CompareOptions options = thesis ? thesis_options() : CompareOptions{};
  for (const auto& [name, text] : given) find_setting(name).set(options, text);
  refuse_of_other_method(given, options.method);
  return options;
}

}  // namespace espdiff
