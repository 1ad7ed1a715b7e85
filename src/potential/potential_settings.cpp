// potential_settings.cpp: the table of options of computed potentials.
#include "potential/potential_settings.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "mapping/map_recipe.h"

namespace espdiff {
namespace {

using Methods = std::vector<PotentialMethod>;
const Methods kPb{PotentialMethod::kPoissonBoltzmann}, kPme{PotentialMethod::kPme}, kCoulomb{PotentialMethod::kCoulomb};

using Rows = RowsOf<PotentialOptions>;
constexpr NumberRange kDielectric{0.001, 1e6};

void add_pb_settings(std::vector<PotentialSetting>& all) {
  all.push_back(
      {"equation", kPb,
       Rows::choice_of<bool>(
           "pb", "", {{"linear", false}, {"nonlinear", true}}, [](auto& o) -> auto& { return o.pb.nonlinear; },
           "The Poisson-Boltzmann equation, linearized or not; nonlinear for nucleic acids and other strong charges")});
  all.push_back({"ionic_strength", kPb,
                 Rows::number(
                     "ionic-strength", "", {0, 100}, [](auto& o) -> auto& { return o.pb.ionic_strength; },
                     "Salt in the solvent, mol/l of singly charged ions; 0 for none")});
  all.push_back({"ion_radius", kPb,
                 Rows::number(
                     "ion-radius", "", {0, 20}, [](auto& o) -> auto& { return o.pb.ion_radius_A; },
                     "Radius of the ions, Angstrom: none come nearer to an atom's sphere (Stern layer)")});
  all.push_back({"solute_dielectric", kPb,
                 Rows::number(
                     "solute-dielectric", "", kDielectric, [](auto& o) -> auto& { return o.pb.solute_dielectric; },
                     "Dielectric constant inside the molecule")});
  all.push_back({"solvent_dielectric", kPb,
                 Rows::number(
                     "solvent-dielectric", "", kDielectric, [](auto& o) -> auto& { return o.pb.solvent_dielectric; },
                     "Dielectric constant of the solvent; 78.54 is water at 298 K")});
  all.push_back(
      {"boundary", kPb,
       Rows::choice_of<DielectricBoundary>(
           "dielectric-boundary", "",
           {{"molecular", DielectricBoundary::kMolecular},
            {"vdw", DielectricBoundary::kVanDerWaals},
            {"gaussian", DielectricBoundary::kGaussian}},
           [](auto& o) -> auto& { return o.pb.dielectric_boundary; },
           "Where the molecule's dielectric ends: at the surface that a probe cannot cross (molecular), at the atoms' "
           "spheres "
           "(vdw), or nowhere: it changes smoothly with a Gaussian density (gaussian)")});
  all.push_back({"probe_radius", kPb,
                 Rows::number(
                     "probe-radius", "", {0, 20}, [](auto& o) -> auto& { return o.pb.probe_radius_A; },
                     "Radius of the probe of the molecular boundary, Angstrom")});
  all.push_back({"smoothing", kPb,
                 Rows::choice_of<DielectricSmoothing>(
                     "dielectric-smoothing", "",
                     {{"edges", DielectricSmoothing::kEdges}, {"nine-point", DielectricSmoothing::kNinePoint}},
                     [](auto& o) -> auto& { return o.pb.smoothing; },
                     "How the boundary is laid on the grid: by where it cuts the edges, or as APBS' smol by nine "
                     "samples, which errs "
                     "three times as much")});
  all.push_back({"gaussian_sigma", kPb,
                 Rows::number(
                     "gaussian-sigma", "", {0.05, 20}, [](auto& o) -> auto& { return o.pb.gaussian_sigma; },
                     "Width of an atom's Gaussian over its radius, for the gaussian boundary")});
  all.push_back(
      {"far_boundary", kPb,
       Rows::choice_of<FarBoundary>(
           "far-boundary", "", {{"debye-hueckel", FarBoundary::kDebyeHueckel}, {"focus", FarBoundary::kFocus}},
           [](auto& o) -> auto& { return o.pb.far_boundary; },
           "Values on the grid's border: focus takes those of a grid of twice the spacing that reaches 20 Angstrom "
           "beyond "
           "the atoms, debye-hueckel the sum of all charges' Debye-Hueckel potentials")});
  all.push_back({"spacing", kPb,
                 Rows::number(
                     "pb-spacing", "", {0.001, 20}, [](auto& o) -> auto& { return o.pb_spacing_A; },
                     "Distance of the grid's points, Angstrom")});
  all.push_back({"padding", kPb,
                 Rows::number(
                     "pb-padding", "", {0.001, 1000}, [](auto& o) -> auto& { return o.pb_padding_A; },
                     "Least space between the atoms' spheres and the grid's border, Angstrom; 12 where the map is "
                     "written and for "
                     "the border debye-hueckel. It is at least 2 more than the largest distance at which a surface is "
                     "read, and 9 "
                     "where side chains are drawn in other places")});
  all.push_back({"tolerance", kPb,
                 Rows::number(
                     "pb-tolerance", "", {1e-14, 1}, [](auto& o) -> auto& { return o.pb.tolerance; },
                     "Error that the iteration may leave in the potentials at the surface, relative to their rms; of "
                     "the nonlinear equation: residual, relative to the right-hand side")});
  all.push_back({"max_cycles", kPb,
                 Rows::count(
                     "pb-max-cycles", "", {1, 1e6}, [](auto& o) -> auto& { return o.pb.max_cycles; },
                     "Cycles of the iteration at most; more are an error")});
}

void add_pme_settings(std::vector<PotentialSetting>& all) {
  all.push_back({"part", kPme,
                 Rows::choice_of<PmePart>(
                     "pme-part", "", {{"full", PmePart::kFull}, {"smooth", PmePart::kSmooth}},
                     [](auto& o) -> auto& { return o.pme.part; },
                     "Which part of Ewald's sum: full is the potential of point charges; smooth leaves out what is "
                     "nearer than about "
                     "1 / Ewald factor, as PMEPot does. Surfaces take full, averages over frames smooth")});
  all.push_back(
      {"grid", kPme,
       Rows::parsed(
           "pme-grid", "", [](PotentialOptions& o, const std::string& text) { o.grid = parse_grid_choice(text); },
           [](const PotentialOptions& o) {
             if (o.grid.size[0] == 0) return written_value(o.grid.resolution_A);
             return std::to_string(o.grid.size[0]) + " " + std::to_string(o.grid.size[1]) + " " +
                    std::to_string(o.grid.size[2]);
           },
           "Grid: a resolution below 8 Angstrom, a number of points from 8 on, or three")});
  all.push_back({"ewaldfactor", kPme,
                 Rows::number(
                     "ewaldfactor", "", {0.001, 10}, [](auto& o) -> auto& { return o.pme.ewald_factor; },
                     "Smearing of the charges in the smooth part, 1/Angstrom: Gaussians of variance 1 / (2 f^2)")});
  all.push_back(
      {"spline", kPme,
       Rows::count(
           "pme-spline", "", {4, 8}, [](auto& o) -> auto& { return o.pme.order; }, "Order of the B-splines")});
  all.push_back({"precision", kPme,
                 Rows::choice_of<Precision>(
                     "pme-precision", "", {{"single", Precision::kSingle}, {"double", Precision::kDouble}},
                     [](auto& o) -> auto& { return o.pme.precision; }, "Precision of the sums")});
  all.push_back({"compatible", kPme,
                 Rows::boolean(
                     "pme-compatible", "", [](auto& o) -> auto& { return o.pme.compatible; },
                     "PMEPot's numbers: its grid sizes, squared spline factor, whole-number volume, smooth part, "
                     "linear samples")});
  all.push_back({"pad", kPme,
                 Rows::optional_number(
                     "pme-pad", "", {0, 1e4}, [](auto& o) -> auto& { return o.pad_A; },
                     "A box around the atoms instead of a cell, wider by so much on each side, Angstrom; 10 where no "
                     "cell is known")});
}

void add_coulomb_settings(std::vector<PotentialSetting>& all) {
  all.push_back({"dielectric", kCoulomb,
                 Rows::number(
                     "dielectric", "", kDielectric, [](auto& o) -> auto& { return o.coulomb.dielectric; },
                     "Dielectric constant everywhere; 1 is vacuum")});
  all.push_back({"distance_dependent", kCoulomb,
                 Rows::boolean(
                     "distance-dependent", "", [](auto& o) -> auto& { return o.coulomb.distance_dependent; },
                     "The dielectric grows with the distance: dielectric times r in Angstrom (4 is ChimeraX's)")});
}

bool reads(const PotentialSetting& setting, PotentialMethod method) {
  return std::find(setting.of.begin(), setting.of.end(), method) != setting.of.end();
}

}  // namespace

std::string PotentialSetting::map_option() const {
  std::string text = of.front() == PotentialMethod::kPoissonBoltzmann ? name : key;
  std::replace(text.begin(), text.end(), '_', '-');
  return text;
}

const std::vector<PotentialSetting>& potential_settings() {
  static const std::vector<PotentialSetting> all = [] {
    std::vector<PotentialSetting> made;
    add_pb_settings(made);
    add_pme_settings(made);
    add_coulomb_settings(made);
    return made;
  }();
  return all;
}

const PotentialSetting& find_potential_setting(const std::string& name) {
  std::string keys;
  for (const PotentialSetting& setting : potential_settings()) {
    if (setting.key == name || setting.name == name) return setting;
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
      throw InputError(option(setting.name) + " is an option of the potential " + to_string(setting.of.front()) +
                       ", and the potential is " + to_string(method) + "; leave it out, or take the potential " +
                       to_string(setting.of.front()));
    setting.set(o, text);
  }
  const bool is_wide = on_lattice || o.pb.far_boundary == FarBoundary::kDebyeHueckel;
  if (is_wide && !is_given("padding")) o.pb_padding_A = kWidePbPadding_A;
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

std::string short_potential(const std::string& words) {
  std::istringstream text(words);
  std::string method, key, value;
  text >> method;
  MapRecipe recipe;
  if (method == to_string(PotentialMethod::kPoissonBoltzmann))
    recipe.method = PotentialMethod::kPoissonBoltzmann;
  else if (method == to_string(PotentialMethod::kCoulomb))
    recipe.method = PotentialMethod::kCoulomb;
  else
    return words;
  PotentialOptions options;
  try {
    while (text >> key >> value) find_potential_setting(key).set(options, value);
  } catch (const InputError&) {
    return words;
  }
  recipe.pb = options.pb;
  recipe.coulomb = options.coulomb;
  return potential_label(recipe);
}

}  // namespace espdiff
