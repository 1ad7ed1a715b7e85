// potential_settings.cpp: the table of options of computed potentials.
#include "potential/potential_settings.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "io/text/text_cursor.h"
#include "mapping/map_recipe.h"

namespace espdiff {
namespace {

using Methods = std::vector<PotentialMethod>;
const Methods kPb{PotentialMethod::kPoissonBoltzmann}, kPme{PotentialMethod::kPme}, kCoulomb{PotentialMethod::kCoulomb};

[[noreturn]] void refuse(const std::string& name, const std::string& text, const std::string& accepted) {
  throw InputError(option(name) + ": '" + text + "' is not " + accepted);
}

std::string written(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << value;
  return out.str();
}

/// A setting that is a number above 0, or with `zero` also 0; `at` finds it in the options.
template <typename At>
PotentialSetting number(const std::string& key, const std::string& name, const Methods& of, bool zero, At at,
                        const std::string& help) {
  PotentialSetting s{key, name, of, SettingKind::kNumber, {}, help, nullptr, nullptr};
  s.set = [name, zero, at](PotentialOptions& o, const std::string& text) {
    double value = 0;
    if (!parse_number(text, value) || !std::isfinite(value) || (zero ? value < 0 : value <= 0))
      refuse(name, text, zero ? "a number of 0 or more" : "a positive number");
    at(o) = value;
  };
  s.get = [at](const PotentialOptions& o) { return written(at(o)); };
  return s;
}

template <typename At>
PotentialSetting boolean(const std::string& key, const std::string& name, const Methods& of, At at,
                         const std::string& help) {
  PotentialSetting s{key, name, of, SettingKind::kBoolean, {}, help, nullptr, nullptr};
  s.set = [name, at](PotentialOptions& o, const std::string& text) {
    if (text != "0" && text != "1") refuse(name, text, "0 or 1");
    at(o) = text == "1";
  };
  s.get = [at](const PotentialOptions& o) { return at(o) ? "1" : "0"; };
  return s;
}

/// A setting with named values, in the order of the choices.
template <typename Value, typename At>
PotentialSetting choice(const std::string& key, const std::string& name, const Methods& of,
                        const std::vector<std::pair<std::string, Value>>& values, At at, const std::string& help) {
  PotentialSetting s{key, name, of, SettingKind::kChoice, {}, help, nullptr, nullptr};
  std::string list;
  for (std::size_t i = 0; i < values.size(); ++i) {
    s.choices.push_back(values[i].first);
    list += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + values[i].first;
  }
  s.set = [=](PotentialOptions& o, const std::string& text) {
    for (const auto& [word, value] : values) {
      if (word != text) continue;
      at(o) = value;
      return;
    }
    refuse(name, text, list);
  };
  s.get = [=](const PotentialOptions& o) {
    for (const auto& [word, value] : values) {
      if (at(o) == value) return word;
    }
    return std::string();
  };
  return s;
}

template <typename At>
PotentialSetting count(const std::string& key, const std::string& name, const Methods& of, At at,
                       const std::string& help) {
  PotentialSetting s{key, name, of, SettingKind::kInteger, {}, help, nullptr, nullptr};
  s.set = [name, at](PotentialOptions& o, const std::string& text) {
    long long value = 0;
    constexpr long long kMost = 1000000;
    if (!parse_integer(text, value) || value < 1 || value > kMost) refuse(name, text, "a whole number of 1 or more");
    at(o) = static_cast<int>(value);
  };
  s.get = [at](const PotentialOptions& o) { return std::to_string(at(o)); };
  return s;
}

void add_pb_settings(std::vector<PotentialSetting>& all) {
  all.push_back(choice<bool>(
      "equation", "pb", kPb, {{"linear", false}, {"nonlinear", true}}, [](auto& o) -> auto& { return o.pb.nonlinear; },
      "The Poisson-Boltzmann equation, linearized or not; nonlinear for nucleic acids and other strong charges"));
  all.push_back(number(
      "ionic_strength", "ionic-strength", kPb, true, [](auto& o) -> auto& { return o.pb.ionic_strength; },
      "Salt in the solvent, mol/l of singly charged ions; 0 for none"));
  all.push_back(number(
      "ion_radius", "ion-radius", kPb, true, [](auto& o) -> auto& { return o.pb.ion_radius_A; },
      "Radius of the ions, Angstrom: none come nearer to an atom's sphere (Stern layer)"));
  all.push_back(number(
      "solute_dielectric", "solute-dielectric", kPb, false, [](auto& o) -> auto& { return o.pb.solute_dielectric; },
      "Dielectric constant inside the molecule"));
  all.push_back(number(
      "solvent_dielectric", "solvent-dielectric", kPb, false, [](auto& o) -> auto& { return o.pb.solvent_dielectric; },
      "Dielectric constant of the solvent; 78.54 is water at 298 K"));
  all.push_back(choice<DielectricBoundary>(
      "boundary", "dielectric-boundary", kPb,
      {{"molecular", DielectricBoundary::kMolecular},
       {"vdw", DielectricBoundary::kVanDerWaals},
       {"gaussian", DielectricBoundary::kGaussian}},
      [](auto& o) -> auto& { return o.pb.dielectric_boundary; },
      "Where the molecule's dielectric ends: at the surface that a probe cannot cross (molecular), at the atoms' "
      "spheres "
      "(vdw), or nowhere: it changes smoothly with a Gaussian density (gaussian)"));
  all.push_back(number(
      "probe_radius", "probe-radius", kPb, true, [](auto& o) -> auto& { return o.pb.probe_radius_A; },
      "Radius of the probe of the molecular boundary, Angstrom"));
  all.push_back(choice<DielectricSmoothing>(
      "smoothing", "dielectric-smoothing", kPb,
      {{"edges", DielectricSmoothing::kEdges}, {"nine-point", DielectricSmoothing::kNinePoint}},
      [](auto& o) -> auto& { return o.pb.smoothing; },
      "How the boundary is laid on the grid: by where it cuts the edges, or as APBS' smol by nine samples, which errs "
      "three times as much"));
  all.push_back(number(
      "gaussian_sigma", "gaussian-sigma", kPb, false, [](auto& o) -> auto& { return o.pb.gaussian_sigma; },
      "Width of an atom's Gaussian over its radius, for the gaussian boundary"));
  all.push_back(choice<FarBoundary>(
      "far_boundary", "far-boundary", kPb,
      {{"debye-hueckel", FarBoundary::kDebyeHueckel}, {"focus", FarBoundary::kFocus}},
      [](auto& o) -> auto& { return o.pb.far_boundary; },
      "Values on the grid's border: the sum of all charges' Debye-Hueckel potentials, or those of a grid of twice the "
      "extent"));
  all.push_back(number(
      "spacing", "pb-spacing", kPb, false, [](auto& o) -> auto& { return o.pb_spacing_A; },
      "Distance of the grid's points, Angstrom"));
  all.push_back(number(
      "padding", "pb-padding", kPb, false, [](auto& o) -> auto& { return o.pb_padding_A; },
      "Space between the atoms' spheres and the grid's border, Angstrom"));
  all.push_back(number(
      "tolerance", "pb-tolerance", kPb, false, [](auto& o) -> auto& { return o.pb.tolerance; },
      "Residual at which the iteration ends, relative to the right-hand side"));
  all.push_back(count(
      "max_cycles", "pb-max-cycles", kPb, [](auto& o) -> auto& { return o.pb.max_cycles; },
      "Cycles of the iteration at most; more are an error"));
}

void add_pme_settings(std::vector<PotentialSetting>& all) {
  all.push_back(choice<PmePart>(
      "part", "pme-part", kPme, {{"full", PmePart::kFull}, {"smooth", PmePart::kSmooth}},
      [](auto& o) -> auto& { return o.pme.part; },
      "Which part of Ewald's sum: full is the potential of point charges; smooth leaves out what is nearer than about "
      "1 / Ewald factor, as PMEPot does. Surfaces take full, averages over frames smooth"));
  PotentialSetting grid{"grid", "pme-grid", kPme, SettingKind::kText, {}, "", nullptr, nullptr};
  grid.help = "Grid: a resolution below 8 Angstrom, a number of points from 8 on, or three";
  grid.set = [](PotentialOptions& o, const std::string& text) { o.grid = parse_grid_choice(text); };
  grid.get = [](const PotentialOptions& o) {
    if (o.grid.size[0] == 0) return written(o.grid.resolution_A);
    return std::to_string(o.grid.size[0]) + " " + std::to_string(o.grid.size[1]) + " " + std::to_string(o.grid.size[2]);
  };
  all.push_back(grid);
  all.push_back(number(
      "ewaldfactor", "ewaldfactor", kPme, false, [](auto& o) -> auto& { return o.pme.ewald_factor; },
      "Smearing of the charges in the smooth part, 1/Angstrom: Gaussians of variance 1 / (2 f^2)"));
  all.push_back(count(
      "spline", "pme-spline", kPme, [](auto& o) -> auto& { return o.pme.order; }, "Order of the B-splines, 4 to 8"));
  all.push_back(choice<Precision>(
      "precision", "pme-precision", kPme, {{"single", Precision::kSingle}, {"double", Precision::kDouble}},
      [](auto& o) -> auto& { return o.pme.precision; }, "Precision of the sums"));
  all.push_back(boolean(
      "compatible", "pme-compatible", kPme, [](auto& o) -> auto& { return o.pme.compatible; },
      "PMEPot's numbers: its grid sizes, squared spline factor, whole-number volume, smooth part, linear samples"));
  PotentialSetting pad{"pad", "pme-pad", kPme, SettingKind::kText, {}, "", nullptr, nullptr};
  pad.help =
      "A box around the atoms instead of a cell, wider by so much on each side, Angstrom; 10 where no cell is known";
  pad.set = [](PotentialOptions& o, const std::string& text) {
    double value = 0;
    if (!parse_number(text, value) || !(value >= 0) || !std::isfinite(value))
      refuse("pme-pad", text, "a number of 0 or more");
    o.pad_A = value;
  };
  pad.get = [](const PotentialOptions& o) { return o.pad_A ? written(*o.pad_A) : std::string(); };
  all.push_back(pad);
}

void add_coulomb_settings(std::vector<PotentialSetting>& all) {
  all.push_back(number(
      "dielectric", "dielectric", kCoulomb, false, [](auto& o) -> auto& { return o.coulomb.dielectric; },
      "Dielectric constant everywhere; 1 is vacuum"));
  all.push_back(boolean(
      "distance_dependent", "distance-dependent", kCoulomb,
      [](auto& o) -> auto& { return o.coulomb.distance_dependent; },
      "The dielectric grows with the distance: dielectric times r in Angstrom (4 is ChimeraX's)"));
}

/// As those of options/settings.cpp.
constexpr SettingLimits kPotentialLimits[] = {{"ion-radius", 0, 20},
                                              {"probe-radius", 0, 20},
                                              {"gaussian-sigma", 0.05, 20},
                                              {"pb-spacing", 0.001, 20},
                                              {"pb-padding", 0.001, 1000},
                                              {"pb-tolerance", 1e-14, 1},
                                              {"ewaldfactor", 0.001, 10},
                                              {"pme-pad", 0, 1e4},
                                              {"ionic-strength", 0, 100},
                                              {"solute-dielectric", 0.001, 1e6},
                                              {"solvent-dielectric", 0.001, 1e6}};

bool reads(const PotentialSetting& setting, PotentialMethod method) {
  return std::find(setting.of.begin(), setting.of.end(), method) != setting.of.end();
}

}  // namespace

std::string PotentialSetting::map_option() const {
  std::string name = of.front() == PotentialMethod::kPoissonBoltzmann ? option : key;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

const std::vector<PotentialSetting>& potential_settings() {
  static const std::vector<PotentialSetting> all = [] {
    std::vector<PotentialSetting> made;
    add_pb_settings(made);
    add_pme_settings(made);
    add_coulomb_settings(made);
    set_limits(made, kPotentialLimits, &PotentialSetting::option);
    return made;
  }();
  return all;
}

const PotentialSetting& find_potential_setting(const std::string& name) {
  std::string keys;
  for (const PotentialSetting& setting : potential_settings()) {
    if (setting.key == name || setting.option == name) return setting;
    keys += (keys.empty() ? "" : ", ") + setting.key;
  }
  throw InputError("a potential has no option '" + name + "'; there are " + keys);
}

PotentialOptions make_potential_options(PotentialMethod method, const GivenPotentialSettings& given,
                                        double temperature_K, bool on_lattice) {
  PotentialOptions o;
  o.method = method;
  o.pme.part = on_lattice ? PmePart::kSmooth : PmePart::kFull;
  const auto is_given = [&](const std::string& key) {
    return std::any_of(given.begin(), given.end(),
                       [&](const auto& g) { return &find_potential_setting(g.first) == &find_potential_setting(key); });
  };
  for (const auto& [name, text] : given) {
    const PotentialSetting& setting = find_potential_setting(name);
    const bool is_lattice = setting.key == "grid" || setting.key == "pad";
    const bool read_here = on_lattice && is_lattice && method == PotentialMethod::kCoulomb;
    if (!reads(setting, method) && !read_here)
      throw InputError(option(setting.option) + " is an option of the potential " + to_string(setting.of.front()) +
                       ", and the potential is " + to_string(method) + "; leave it out, or take the potential " +
                       to_string(setting.of.front()));
    setting.set(o, text);
  }
  if (o.pme.compatible) {
    if (!is_given("part")) o.pme.part = PmePart::kSmooth;
    if (!is_given("spline")) o.pme.order = usual_order(true);
    if (!is_given("grid") && !on_lattice) o.grid.resolution_A = 0.5;  // linear samples want more points than splines
  }
  o.pme.temperature_K = o.coulomb.temperature_K = o.pb.temperature_K = temperature_K;
  return o;
}

std::string potential_in_words(const PotentialOptions& options) {
  std::string words = to_string(options.method);
  for (const PotentialSetting& setting : potential_settings()) {
    const std::string value = reads(setting, options.method) ? setting.get(options) : std::string();
    if (!value.empty()) words += " " + setting.key + " " + value;
  }
  return words;
}

}  // namespace espdiff
