// pme_modes.cpp: the particle-mesh potential in PMEPot's form, its smooth samples, and refusals.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "base/error.h"
#include "cuda/potential/ewald_oracle.h"
#include "engine/engine.h"
#include "engine/potential_stage.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;

TEST_SUITE_BEGIN("pme");

TEST_CASE("the compatible mode's values are coefficients whose splines give the potential") {
  // A whole volume, so that truncating it changes nothing.
  const PmeCell cell = cell_of({24, 25, 30}, {90, 90, 90}, {1, 2, 3});
  const Charges atoms = random_charges(cell, 100, 18);
  PmeOptions options;
  options.size = {24, 25, 30};
  options.order = 4;
  options.precision = espdiff::Precision::kDouble;
  for (const auto& engine : engines_with_fourier()) {
    const Grid points = pme_map(*engine, atoms, cell, options);
    PmeOptions compatible = options;
    compatible.compatible = true;
    const Grid coefficients = pme_map(*engine, atoms, cell, compatible);
    std::vector<float> summed(points.values.size());
    const double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    for (int i = 0; i < static_cast<int>(summed.size()); ++i) {
      double sum = 0;
      for (int n = 0; n < 27; ++n) {
        const int x = (i % 24 + n % 3 + 23) % 24, y = (i / 24 % 25 + n / 3 % 3 + 24) % 25,
                  z = (i / 600 + n / 9 + 29) % 30;
        sum += weight[n % 3] * weight[n / 3 % 3] * weight[n / 9] *
               static_cast<double>(coefficients.values[static_cast<std::size_t>(x + 24 * (y + 25 * z))]);
      }
      summed[static_cast<std::size_t>(i)] = static_cast<float>(sum);
    }
    CHECK(relative_max(summed, points.values) < 1e-6);
    CHECK(relative_max(coefficients.values, points.values) > 1e-3);
  }
  // A volume that is not whole: 24.5 * 25 * 30.3 = 18558.75 against 18558.
  const PmeCell part = cell_of({24.5, 25, 30.3}, {90, 90, 90}, {});
  for (const auto& engine : engines_with_fourier()) {
    PmeOptions compatible = options;
    compatible.compatible = true;
    PmeCell whole = part;
    const double exact = 24.5 * 25 * 30.3;
    const Grid truncated = pme_map(*engine, atoms, part, compatible);
    compatible.temperature_K = 300 * exact / std::trunc(exact);
    const Grid scaled = pme_map(*engine, atoms, whole, compatible);
    CHECK(static_cast<double>(truncated.values[5]) / static_cast<double>(scaled.values[5]) ==
          doctest::Approx(exact / std::trunc(exact)).epsilon(1e-6));
  }
}

TEST_CASE("smooth samples are as accurate between the points as on them; the map's own points stay the same") {
  Random random(19);
  for (const auto& engine : engines_with_fourier()) {
    for (const NamedCell& named : cells()) {
      const PmeCell& cell = named.cell;
      const Charges atoms = random_charges(cell, 150, 20);
      PmeOptions options = options_for(cell, 1.0);
      const Grid plain = pme_map(*engine, atoms, cell, options);
      options.smooth_samples = true;
      const espdiff::RigidTransform to_map = random_rigid(random, 20);
      const auto map = engine->pme_potential(atoms.positions, atoms.charges, cell, options, to_map, {});
      espdiff::Lattice lattice;
      lattice.size = {6, 5, 4};
      lattice.origin = {-60, 3, 11};  // anywhere: the map is periodic
      lattice.step = {{{7.1, 0.4, 0}, {0, 9.3, 1}, {-2, 0, 8.7}}};
      const Grid sampled = engine->download(engine->resample(map, lattice));
      std::vector<Vec3d> points;
      for (std::size_t i = 0; i < lattice.n_points(); ++i) points.push_back(to_map.apply(lattice_point(lattice, i)));
      const std::vector<double> values(sampled.values.begin(), sampled.values.end());
      CAPTURE(named.name);
      CHECK(relative_rms(values, direct_ewald(atoms, cell, options.ewald_factor, points)) < 1e-4);
      CHECK(relative_max(engine->download(map).values, plain.values) < 3e-6);
      CHECK(engine->download(map).periodic);
    }
  }
}

TEST_CASE("wrong input is refused with its name, the value, the limit and a remedy") {
  const PmeCell cell = cells()[0].cell;
  const Charges atoms = random_charges(cell, 20, 21);
  PmeOptions options = options_for(cell, 1.0);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [&](Engine& engine, const Charges& a, const PmeCell& c, const PmeOptions& o) {
    CHECK_THROWS_AS(pme_map(engine, a, c, o), espdiff::Error);
    return message_of([&] { pme_map(engine, a, c, o); });
  };
  const auto has = [](const std::string& text, const std::string& part) {
    CHECK_MESSAGE(text.find(part) != std::string::npos, text);
  };
  for (const auto& engine : engines_with_fourier()) {
    PmeCell flat = cell, left = cell, lost = cell;
    flat.edges[2] = flat.edges[0] + flat.edges[1];
    std::swap(left.edges[0], left.edges[1]);
    lost.centre.y = kNan;
    has(refusal(*engine, atoms, flat, options), "span a volume of");
    has(refusal(*engine, atoms, left, options), "must be positive");
    has(refusal(*engine, atoms, lost, options), "not finite");
    Charges none = atoms, nowhere = atoms, infinite = atoms, fewer = atoms;
    none.charges.assign(20, 0.0F);
    nowhere.positions[4].z = kNan;
    infinite.charges[2] = std::numeric_limits<float>::infinity();
    fewer.charges.pop_back();
    has(refusal(*engine, none, cell, options), "none of the 20 atoms has a charge; take charges from a topology");
    has(refusal(*engine, nowhere, cell, options), "atom 5 has a coordinate that is not finite");
    has(refusal(*engine, infinite, cell, options), "atom 3 has a charge that is not finite");
    has(refusal(*engine, fewer, cell, options), "20 positions but 19 charges");
    for (const auto& [change, expected] : std::vector<std::pair<std::function<void(PmeOptions&)>, std::string>>{
             {[](PmeOptions& o) {
                o.size = {5, 32, 32};
              },
              "each edge needs 6 (splines of order 6) to 4096"},
             {[](PmeOptions& o) {
                o.size = {32, 32, 5000};
              },
              "5000 points"},
             {[](PmeOptions& o) {
                o.size = {4096, 4096, 4096};
              },
              "would fit"},
             {[](PmeOptions& o) { o.order = 3; }, "spline order 3 is not among 4 to 8"},
             {[](PmeOptions& o) { o.order = 9; }, "spline order 9"},
             {[](PmeOptions& o) { o.ewald_factor = 0; }, "Ewald factor 0 1/A is not a positive number"},
             {[](PmeOptions& o) { o.ewald_factor = 1e-4, o.part = espdiff::PmePart::kFull; },
              "ewaldfactor: 0.0001 makes each value of the potential a sum over all charges within 35000 A, "},
             {[](PmeOptions& o) { o.ewald_factor = 1e-12, o.part = espdiff::PmePart::kFull; }, "years of one core"},
             {[](PmeOptions& o) { o.temperature_K = -1; }, "temperature -1 K"},
             {[](PmeOptions& o) { o.compatible = true; }, "PMEPot's is 4"},
             {[](PmeOptions& o) {
                o.compatible = true, o.order = 4, o.size = {7, 8, 8};
              },
              "needs 8 (PMEPot's least)"},
             {[](PmeOptions& o) {
                o.compatible = true, o.order = 4, o.size = {9, 8, 9};
              },
              "even numbers only"}}) {
      PmeOptions wrong = options;
      change(wrong);
      has(refusal(*engine, atoms, cell, wrong), expected);
    }
  }
}

TEST_SUITE_END();
