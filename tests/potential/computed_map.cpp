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
#include "report/write_compare.h"

using namespace espdiff_test;
using espdiff::ComputedMap;
using espdiff::PotentialOptions;

namespace {

std::unique_ptr<Engine> cpu() { return espdiff::select_engine(espdiff::DeviceChoice::kCpu, 2); }

bool can_run() {
  try {
    espdiff::potential_map(*cpu(), make_side(1, 0).molecule, {}, {});
    return true;
  } catch (const espdiff::DeviceError& error) {
    MESSAGE("SKIPPED: ", std::string(error.what()));
    return false;
  }
}

PotentialOptions grid_of(double resolution_A) {
  PotentialOptions options;
  options.grid.resolution_A = resolution_A;
  return options;
}

ComputedMap map_of(const Molecule& molecule, double resolution_A = 1) {
  return {molecule, std::nullopt, grid_of(resolution_A)};
}

CompareInput computed(const Side& side) { return {&side.molecule, nullptr, map_of(side.molecule).maker()}; }

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
  const auto engine = cpu();
  const Grid source_map = espdiff::potential_map(*engine, source.molecule, grid_of(0.5), {}),
             target_map = espdiff::potential_map(*engine, target.molecule, grid_of(0.5), {});
  const CompareResult linear = compare(*engine, {&source.molecule, &source_map}, {&target.molecule, &target_map},
                                       quick_options(), {}),
                      spline = compare(*engine, computed(source), computed(target), quick_options(), {});
  for (const bool is_source : {true, false}) {
    const Molecule& molecule = is_source ? source.molecule : target.molecule;
    const auto& s = spline.surface;
    REQUIRE(hash_of(linear) != hash_of(spline));
    std::vector<Vec3d> points = is_source ? s.source_positions : s.positions;
    points.resize(100);
    const std::vector<double> exact =
        direct_ewald({molecule.positions, molecule.charges}, map_of(molecule).recipe().cell, 0.25, points);
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
  const auto engine = cpu();
  int n_made = 0;
  CompareInput counted = computed(source);
  counted.make_map = [&n_made, make = counted.make_map](Engine& e, const auto& to_map, const auto& progress) {
    ++n_made;
    return make(e, to_map, progress);
  };
  espdiff::Series series(*engine, counted, quick_options());
  for (const double noise : {0.1, 0.2, 0.3}) {
    const Side target = make_side(1, noise);
    const CompareResult step = series.step(computed(target), espdiff::StartFrom::kSource, {});
    CHECK(step.unit == PotentialUnit::kKtPerE);
    CHECK(hash_of(step) == hash_of(compare(*engine, computed(source), computed(target), quick_options(), {})));
  }
  CHECK(n_made == 1);
}

TEST_CASE("a computed map beside a given one in another unit: both in kT/e") {
  if (!can_run()) return;
  const Side source = make_side(1, 0), target = other_side();
  const auto engine = cpu();
  Side in_millivolt = target;
  in_millivolt.map.unit = PotentialUnit::kMillivolt;
  const double factor = espdiff::conversion_factor(PotentialUnit::kKtPerE, PotentialUnit::kMillivolt, 300);
  for (float& v : in_millivolt.map.values) v *= static_cast<float>(factor);
  const CompareResult plain = compare(*engine, computed(source), target.input(), quick_options(), {});
  for (const bool swapped : {false, true}) {
    const CompareResult mixed = swapped ? compare(*engine, in_millivolt.input(), computed(source), quick_options(), {})
                                        : compare(*engine, computed(source), in_millivolt.input(), quick_options(), {});
    CHECK(mixed.unit == PotentialUnit::kKtPerE);
    if (!swapped)
      CHECK(mixed.metrics.mean_signed_difference ==
            doctest::Approx(plain.metrics.mean_signed_difference).epsilon(1e-5));
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
  const auto engine = cpu();
  const CompareResult result = compare(*engine, computed(source), computed(moved), quick_options(), {});
  CHECK(result.metrics.mean_abs_difference < 0.01 * result.metrics.rms_difference + 0.05);
  CHECK(result.metrics.hodgkin_index > 0.9999);
}

TEST_CASE("a result tells of a computed map what is needed to compute it again") {
  const Side side = make_side(1, 0);
  PotentialOptions options;
  options.pme.ewald_factor = 0.3;
  const ComputedMap map(side.molecule, espdiff::UnitCell{{60, 61, 62}, {90, 90, 90}}, options);
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
  CHECK(map.fingerprint() ==
        ComputedMap(side.molecule, espdiff::UnitCell{{60, 61, 62}, {90, 90, 90}}, options).fingerprint());
  CHECK(map.fingerprint() != map_of(side.molecule).fingerprint());
  Molecule changed = side.molecule;
  changed.charges[0] += 0.1F;
  CHECK(map_of(changed).fingerprint() != map_of(side.molecule).fingerprint());
  CHECK(map_of(side.molecule, 0.9).fingerprint() != map_of(side.molecule).fingerprint());
}

TEST_CASE("what cannot be computed is refused before the surface is made") {
  Molecule molecule = make_side(1, 0).molecule;
  PotentialOptions options;
  options.method = espdiff::PotentialMethod::kCoulomb;
  CHECK(message_of([&] { ComputedMap(molecule, std::nullopt, options); }).find("computes potentials by pme") !=
        std::string::npos);
  options = {};
  options.cell = espdiff::PmeCell{{}, {Vec3d{50, 0, 0}, Vec3d{0, 50, 0}, Vec3d{0, 0, 50}}};
  options.pad_A = 5;
  CHECK(message_of([&] { ComputedMap(molecule, std::nullopt, options); }) ==
        "a cell and a padding were given; leave one out");
  molecule.charges.clear();
  CHECK(message_of([&] { map_of(molecule); }).find("molecule.pqr: has no charges") == 0);
}

TEST_SUITE_END();
