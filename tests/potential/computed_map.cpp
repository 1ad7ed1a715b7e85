// computed_map.cpp: potentials that a comparison computes: exact at the surface, made once for a series, in one unit
// with given maps, and told of in the result.
#include "potential/computed_map.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "compare/compare.h"
#include "compare/made_side.h"
#include "compare/series.h"
#include "cuda/potential/ewald_oracle.h"
#include "engine/engine.h"
#include "mapping/input.h"
#include "mapping/map_recipe.h"
#include "potential/choose_potential.h"
#include "potential/cpu_engine.h"
#include "potential/potential.h"
#include "potential/potential_series.h"
#include "potential/potential_settings.h"
#include "report/compare_json.h"
#include "report/sections/provenance.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::ComputedMap;
using espdiff::PotentialOptions;

namespace {

PotentialOptions grid_of(double resolution_A) {
  PotentialOptions options;
  options.grid.resolution_A = resolution_A;
  return options;
}

ComputedMap map_of(const Molecule& molecule, double resolution_A = 1) { return {molecule, {}, grid_of(resolution_A)}; }

CompareInput computed(const Side& side) { return {&side.molecule, nullptr, map_of(side.molecule).maker()}; }

/// The same in the box along the coordinate axes that `espdiff potential` lays.
CompareInput in_box(const Side& side) {
  PotentialOptions options = grid_of(1);
  options.cell = espdiff::padded_cell(side.molecule.positions, 10);
  return {&side.molecule, nullptr, ComputedMap(side.molecule, {}, options).maker()};
}

/// The molecule with some of its atoms moved.
Side other_side() { return make_side(1, 0.3); }

double rms_error(const std::vector<float>& samples, const std::vector<double>& exact) {
  double sum = 0, square = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double error = static_cast<double>(samples[i]) - exact[i];
    sum += error * error;
    square += exact[i] * exact[i];
  }
  return std::sqrt(sum / square);
}

}  // namespace

TEST_SUITE_BEGIN("computed_map");

TEST_CASE("splines on 1 A are nearer to the direct Ewald sum at the surface than linear samples on 0.5 A") {
  if (!can_run()) return;
  const Side source = make_side(1, 0), target = other_side();
  const auto engine = cpu(2);
  const Grid source_map = espdiff::potential_map(*engine, source.molecule, grid_of(0.5), {}),
             target_map = espdiff::potential_map(*engine, target.molecule, grid_of(0.5), {});
  const CompareResult linear = compare(*engine, {&source.molecule, &source_map}, {&target.molecule, &target_map},
                                       quick_options(), {}),
                      spline = compare(*engine, in_box(source), in_box(target), quick_options(), {});
  for (const bool is_source : {true, false}) {
    const Molecule& molecule = is_source ? source.molecule : target.molecule;
    const auto& s = spline.surface;
    REQUIRE(hash_of(linear) != hash_of(spline));
    std::vector<Vec3d> points = is_source ? s.source_positions : s.positions;
    points.resize(100);
    const std::vector<double> exact = direct_ewald({molecule.positions, molecule.charges},
                                                   espdiff::padded_cell(molecule.positions, 10), 0.25, points);
    const auto& l = linear.surface;
    const double of_spline = rms_error(is_source ? s.potential_source : s.potential_target, exact),
                 of_linear = rms_error(is_source ? l.potential_source : l.potential_target, exact);
    MESSAGE("relative rms error: splines ", of_spline, ", linear ", of_linear);
    CHECK(of_spline < 1e-4);
    CHECK(of_spline < 0.1 * of_linear);
  }
}

TEST_CASE("a series makes the source's map once, and gives the same bits as comparisons one by one") {
  if (!can_run()) return;
  const Side source = make_side(1, 0);
  const auto engine = cpu(2);
  int n_made = 0;
  CompareInput counted = computed(source);
  counted.make_map = [&n_made, make = counted.make_map](Engine& e, const auto& to_map, const auto& before,
                                                        const auto& progress) {
    ++n_made;
    return make(e, to_map, before, progress);
  };
  espdiff::Series series(*engine, counted, quick_options());
  for (const double noise : {0.1, 0.2, 0.3}) {
    const Side target = make_side(1, noise);
    const CompareResult step = series.step(computed(target), espdiff::StartFrom::kSource, {});
    CHECK(step.potential.unit == PotentialUnit::kKtPerE);
    CHECK(hash_of(step) == hash_of(compare(*engine, computed(source), computed(target), quick_options(), {})));
  }
  CHECK(n_made == 1);
}

TEST_CASE("a computed map beside a given one in another unit: both in kT/e") {
  if (!can_run()) return;
  const Side source = make_side(1, 0), target = other_side();
  const auto engine = cpu(2);
  Side in_millivolt = target;
  in_millivolt.map.unit = PotentialUnit::kMillivolt;
  const double factor = espdiff::conversion_factor(PotentialUnit::kKtPerE, PotentialUnit::kMillivolt, 300);
  for (float& v : in_millivolt.map.values) v *= static_cast<float>(factor);
  const CompareResult plain = compare(*engine, computed(source), target.input(), quick_options(), {});
  for (const bool swapped : {false, true}) {
    const CompareResult mixed = swapped ? compare(*engine, in_millivolt.input(), computed(source), quick_options(), {})
                                        : compare(*engine, computed(source), in_millivolt.input(), quick_options(), {});
    CHECK(mixed.potential.unit == PotentialUnit::kKtPerE);
    if (!swapped)
      CHECK(mixed.potential.metrics.mean_signed_difference ==
            doctest::Approx(plain.potential.metrics.mean_signed_difference).epsilon(1e-5));
  }
  in_millivolt.map.unit = PotentialUnit::kUnknown;
  CHECK(message_of([&] { compare(*engine, computed(source), in_millivolt.input(), quick_options(), {}); }) ==
        "the maps are in two units: kT/e (computed) and unknown (map.dx); name the unknown one's unit "
        "(target-map-unit)");
  CHECK(message_of([&] {
          compare(*engine, computed(source), target.shape(), quick_options(), {});
        }).find("was given for the source only") != std::string::npos);
}

TEST_CASE("charges turned and moved with their molecule give the same potentials at its surface") {
  if (!can_run()) return;
  const Side source = make_side(1, 0);
  Side moved = source;
  const espdiff::RigidTransform turn{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {40, -3, 7}};
  for (Vec3d& p : moved.molecule.positions) p = turn.apply(p);
  const auto engine = cpu(2);
  const CompareResult result = compare(*engine, computed(source), computed(moved), quick_options(), {});
  CHECK(result.potential.metrics.mean_abs_difference < 0.01 * result.potential.metrics.rms_difference + 0.05);
  CHECK(result.potential.metrics.hodgkin_index > 0.9999);
}

TEST_CASE("a result tells of a computed map what is needed to compute it again") {
  const Side side = make_side(1, 0);
  PotentialOptions options;
  options.pme.ewald_factor = 0.3;
  const espdiff::ChargeSurroundings in_cell{espdiff::UnitCell{{60, 61, 62}, {90, 90, 90}}, {}, false};
  const ComputedMap map(side.molecule, in_cell, options);
  espdiff::Provenance provenance;
  provenance.inputs = {computed_input("source_map", map)};
  const auto json = compare_json(side.molecule, side.molecule, CompareResult(), {}, provenance);
  const auto& input = json["inputs"][0];
  CHECK(input["role"] == "source_map");
  CHECK(input["path"] == "pme of molecule.pqr");
  CHECK(input["sha256"] == map.fingerprint());
  CHECK(input["computed"]["method"] == "pme");
  CHECK(input["computed"]["charges_from"] == "molecule.pqr");
  CHECK(input["computed"]["n_charges"] == 18);
  CHECK(input["computed"]["cell_from"] == "its own");
  CHECK(input["computed"]["cell_edges_A"][1][1] == doctest::Approx(61));
  CHECK(input["computed"]["grid"] == nlohmann::json({60, 63, 63}));
  CHECK(input["computed"]["spline_order"] == 6);
  CHECK(input["computed"]["ewald_factor"] == 0.3);
  CHECK(input["computed"]["sampling"] == "spline");
  // All that the map depends on changes the fingerprint.
  CHECK(map.fingerprint() == ComputedMap(side.molecule, in_cell, options).fingerprint());
  CHECK(map.fingerprint() != map_of(side.molecule).fingerprint());
  Molecule changed = side.molecule;
  changed.charges[0] += 0.1F;
  CHECK(map_of(changed).fingerprint() != map_of(side.molecule).fingerprint());
  CHECK(map_of(side.molecule, 0.9).fingerprint() != map_of(side.molecule).fingerprint());
}

TEST_CASE("what cannot be computed is refused before the surface is made") {
  Molecule molecule = make_side(1, 0).molecule;
  PotentialOptions options;
  options.cell = espdiff::PmeCell{{}, {Vec3d{50, 0, 0}, Vec3d{0, 50, 0}, Vec3d{0, 0, 50}}};
  options.pad_A = 5;
  CHECK(message_of([&] { ComputedMap(molecule, {}, options); }) == "a cell and a padding were given; leave one out");
  options = {};
  options.method = espdiff::PotentialMethod::kPoissonBoltzmann;
  Molecule wet = molecule;
  wet.residues[0].name = "HOH";
  CHECK(
      message_of([&] { ComputedMap(wet, {}, options); }) ==
      "molecule.pqr: water is among the atoms, and Poisson-Boltzmann has a continuum in its place; leave water out, or "
      "take the potential pme");
  wet = molecule;
  wet.radii.clear();
  CHECK(message_of([&] { ComputedMap(wet, {}, options); }) ==
        "molecule.pqr: Poisson-Boltzmann needs the atoms' radii; give a PQR file");
  molecule.charges.clear();
  CHECK(message_of([&] { map_of(molecule); }).find("molecule.pqr: has no charges") == 0);
}

TEST_CASE("what a reader must know of two potentials") {
  espdiff::MapRecipe a, b;
  a.method = b.method = espdiff::PotentialMethod::kPme;
  a.zero = b.zero = espdiff::ZeroPlace::kCellMean;
  a.cell = b.cell = espdiff::PmeCell{{}, {Vec3d{50, 0, 0}, Vec3d{0, 50, 0}, Vec3d{0, 0, 50}}};
  a.has_water = b.has_water = true;
  CHECK(espdiff::potential_notes(&a, &b).empty());
  a.net_charge = -3;
  b.net_charge = -2;
  CHECK(espdiff::potential_notes(&a, &b) ==
        std::vector<std::string>{"the net charges differ, -3 and -2 e: each periodic cell is neutralized by a uniform "
                                 "background of its own, which changes the difference; zero is the mean of the cell"});
  b = a;
  b.cell.edges[0].x = 52;
  CHECK(espdiff::potential_notes(&a, &b) ==
        std::vector<std::string>{"the periodic cells differ, 125000 and 130000 A^3: the zero, the mean of the cell, "
                                 "depends on that where the molecule is charged"});
  b = a;
  b.zero = espdiff::ZeroPlace::kBulkSolvent;
  CHECK(espdiff::potential_notes(&a, &b) ==
        std::vector<std::string>{"zero is the mean of the cell of the source's potential and the bulk solvent of the "
                                 "target's: the mean signed difference means little"});
  b = a;
  a.has_water = b.has_water = false;
  CHECK(espdiff::potential_label(a) == "vacuum (PME without water, smooth part)");
  CHECK(espdiff::potential_notes(&a, &b).size() == 1);
  a.method = b.method = espdiff::PotentialMethod::kPoissonBoltzmann;
  a.net_charge = b.net_charge = 0.5;
  CHECK(espdiff::potential_notes(&a, nullptr) ==
        std::vector<std::string>{"the charges of the source add up to 0.5000 e, which is not a whole number: atoms or "
                                 "charges may be missing"});
}

TEST_CASE(
    "a Poisson-Boltzmann map reaches 6 A beyond the atoms, farther where it is read farther out, 12 A if written") {
  const auto engine = cpu();
  Molecule ion;
  ion.positions = {{0, 0, 0}};
  ion.radii = {2.0F};
  ion.charges = {1.0F};
  espdiff::PotentialOptions options;
  options.method = espdiff::PotentialMethod::kPoissonBoltzmann;
  options.pb_spacing_A = 1;
  const espdiff::MapMaker maker = ComputedMap(ion, {}, options).maker();
  const auto half_extent = [&](double reach_A) {
    const espdiff::Lattice lattice = maker(*engine, {}, {nullptr, false, reach_A}, {}).recipe.pb_lattice;
    return 0.5 * (lattice.size[0] - 1);
  };
  CHECK(half_extent(0) == 8);
  CHECK(half_extent(4) == 8);
  CHECK(half_extent(11) == 16);
  const auto padding = [](bool on_lattice) {
    return espdiff::make_potential_options(espdiff::PotentialMethod::kPoissonBoltzmann, {}, 300, on_lattice)
        .pb_padding_A;
  };
  CHECK(padding(false) == 6);
  CHECK(padding(true) == 12);
}

TEST_CASE("a mean over frames is named so") {
  espdiff::MapRecipe recipe;
  recipe.has_water = true;
  recipe.pme.part = espdiff::PmePart::kFull;
  CHECK(espdiff::potential_label(recipe) == "PME with explicit water");
  recipe.n_frames = 5;
  CHECK(espdiff::potential_label(recipe) == "PME with explicit water, mean over 5 frames");
}

TEST_CASE("which potential is taken where none is named") {
  using Facts = espdiff::PotentialFacts;
  const auto kind = [](const std::vector<Facts>& facts) {
    const espdiff::PotentialChoice choice = espdiff::choose_potential("auto", "auto", facts);
    return (choice.method ? to_string(*choice.method) : std::string("none")) + (choice.own_cell ? " own" : "") + ": " +
           choice.because;
  };
  const Facts bare{"a.pdb", false, false}, charged{"a.pqr", true, false}, solvated{"b.pqr", true, true};
  CHECK(kind({charged, charged}) == "pb: charges without explicit water in a periodic cell");
  CHECK(kind({charged, solvated}) == "pb: charges without explicit water in a periodic cell");
  const Facts salty{"c.pqr", true, true, 5530, 20, 20};
  CHECK(kind({solvated, solvated}) ==
        "pb: a continuum in place of the explicit water of single frames; salt of the 0 ions counted in it");
  CHECK(kind({salty, salty}) ==
        "pb: a continuum in place of the explicit water of single frames; salt of the 20 ions counted in it");
  const espdiff::PotentialChoice salt = espdiff::choose_potential("auto", "auto", {salty, solvated});
  CHECK(salt.ionic_strength.value() == doctest::Approx(0.05));
  CHECK(espdiff::with_salt(salt, {}).front().second == "0.05");
  CHECK(espdiff::with_salt(salt, {{"ionic-strength", "0.2"}}).size() == 1);
  const espdiff::PotentialChoice averaged = espdiff::choose_potential("auto", "auto", {salty, salty}, true);
  CHECK(to_string(*averaged.method) == "pme");
  CHECK(averaged.own_cell);
  CHECK(!averaged.ionic_strength);
  CHECK(kind({charged, bare}) == "none: a.pdb has no charges");
  CHECK(!espdiff::choose_potential("none", "auto", {charged, charged}).method);
  CHECK(message_of([&] { espdiff::choose_potential("pbe", "auto", {charged}); }) ==
        "unknown potential 'pbe'; use pb, pme or coulomb");
}

TEST_CASE("options of a potential: each refused with its name, and those that it does not read") {
  using espdiff::PotentialMethod;
  const auto refused = [](PotentialMethod method, const std::string& name, const std::string& text) {
    return message_of([&] { espdiff::make_potential_options(method, {{name, text}}, 300); });
  };
  const PotentialMethod pb = PotentialMethod::kPoissonBoltzmann, pme = PotentialMethod::kPme;
  CHECK(refused(pb, "ionic-strength", "-0.1") == "ionic-strength: '-0.1' is not a number from 0 to 100");
  CHECK(refused(PotentialMethod::kPme, "ewaldfactor", "0.0001") ==
        "ewaldfactor: '0.0001' is not a number from 0.001 to 10");
  CHECK(refused(pb, "padding", "1e9") == "pb-padding: '1e9' is not a number from 0.001 to 1000");
  CHECK(refused(pb, "solute_dielectric", "0") == "solute-dielectric: '0' is not a number from 0.001 to 1e+06");
  CHECK(refused(pb, "dielectric-boundary", "smol") == "dielectric-boundary: 'smol' is not molecular, vdw or gaussian");
  CHECK(refused(pme, "ionic-strength", "0.1") ==
        "ionic-strength is an option of the potential pb, and the potential is pme; leave it out, or take the "
        "potential pb");
  CHECK(refused(pme, "part", "some") == "pme-part: 'some' is not full or smooth");
  CHECK(refused(pb, "salt", "0.1").find("a potential has no option 'salt'; there are equation, ionic_strength") == 0);
  for (const espdiff::PotentialSetting& setting : espdiff::potential_settings()) {
    // What a setting says of itself it takes.
    const PotentialOptions defaults = espdiff::make_potential_options(setting.of.front(), {}, 300);
    const std::string value = setting.get(defaults);
    PotentialOptions other = defaults;
    if (!value.empty()) setting.set(other, value);
    CHECK(setting.get(other) == value);
  }
}

TEST_CASE("a potential's settings are told in a few words") {
  using espdiff::PotentialMethod;
  const auto told = [](PotentialMethod method, const espdiff::GivenPotentialSettings& given) {
    return espdiff::short_potential(espdiff::potential_in_words(espdiff::make_potential_options(method, given, 300)));
  };
  CHECK(told(PotentialMethod::kPoissonBoltzmann, {}) == "Poisson-Boltzmann, 0.15 mol/l");
  CHECK(told(PotentialMethod::kPoissonBoltzmann, {{"equation", "nonlinear"}, {"ionic_strength", "0.5"}}) ==
        "nonlinear Poisson-Boltzmann, 0.5 mol/l");
  CHECK(told(PotentialMethod::kCoulomb, {}) == "vacuum (Coulomb)");
  CHECK(told(PotentialMethod::kCoulomb, {{"dielectric", "4"}}) == "Coulomb, dielectric 4");
  for (const char* const text : {"maps", "pb of_another_version 1", "pme spline 6", ""})
    CHECK(espdiff::short_potential(text) == text);
}

TEST_SUITE_END();
