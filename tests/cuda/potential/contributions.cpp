// contributions.cpp: what each charge adds to a reading, against potentials of one charge at a time and against
// Kirkwood's series.
#include <doctest/doctest.h>

#include <cstring>
#include <functional>

#include "cuda/potential/ewald_oracle.h"
#include "cuda/potential/poisson_boltzmann_inputs.h"

using namespace espdiff_test;
using espdiff::GridPtr;
using espdiff::MeshPtr;
using espdiff::PotentialReading;

namespace {

using MapOfCharges = std::function<GridPtr(Engine&, const std::vector<float>&)>;

/// Twelve charged spheres in a row of overlapping ones.
Molecule charged_chain() {
  Random random(91);
  Molecule m;
  for (int i = 0; i < 12; ++i) {
    m.positions.push_back(Vec3d{1.3 * i - 8, 0, 0} + random.in_box(1.2));
    m.radii.push_back(static_cast<float>(random.uniform(1.2, 2)));
    m.charges.push_back(static_cast<float>(random.uniform(-1, 1)));
  }
  return m;
}

/// Weights of both signs on a third of the vertices.
std::vector<double> some_weights(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> weights(n, 0.0);
  for (std::size_t v = 0; v < n; v += 3) weights[v] = random.uniform(-0.3, 1) / static_cast<double>(n);
  return weights;
}

/// A reading of each vector of weights.
std::vector<PotentialReading> readings_at(Engine& engine, const MeshPtr& mesh,
                                          const std::vector<std::vector<double>>& weights) {
  std::vector<PotentialReading> readings;
  for (const std::vector<double>& of_reading : weights)
    readings.push_back({engine.download_positions(mesh), of_reading});
  return readings;
}

double reading_of(Engine& engine, const GridPtr& map, const MeshPtr& mesh, const std::vector<double>& weights) {
  const std::vector<float> samples = engine.download(engine.sample(map, mesh));
  double sum = 0;
  for (std::size_t v = 0; v < weights.size(); ++v) {
    if (weights[v] != 0) sum += weights[v] * static_cast<double>(samples[v]);
  }
  return sum;
}

/// The contributions to two readings against the readings of each charge alone, and their sums against those of all.
void check_against_single_charges(Engine& engine, const MapOfCharges& make, const std::vector<float>& charges,
                                  const MeshPtr& mesh) {
  const std::size_t n = engine.n_vertices(mesh);
  const std::vector<std::vector<double>> weights{some_weights(n, 92), some_weights(n, 93)};
  const GridPtr map = make(engine, charges);
  const auto found = engine.contributions(map, readings_at(engine, mesh, weights), {}, {});
  REQUIRE(found.size() == 2);
  for (std::size_t r = 0; r < 2; ++r) {
    REQUIRE(found[r].size() == charges.size());
    double largest = 0, sum = 0, sizes = 0, worst = 0;
    for (const double c : found[r]) {
      largest = std::max(largest, std::fabs(c));
      sum += c;
      sizes += std::fabs(c);
    }
    for (std::size_t i = 0; i < charges.size(); i += 3) {
      std::vector<float> alone(charges.size(), 0.0F);
      alone[i] = charges[i];
      worst = std::max(worst, std::fabs(reading_of(engine, make(engine, alone), mesh, weights[r]) - found[r][i]));
    }
    CHECK(worst < 1e-4 * largest);
    CHECK(std::fabs(sum - reading_of(engine, map, mesh, weights[r])) < 1e-5 * sizes);
  }
}

}  // namespace

TEST_SUITE_BEGIN("contributions");

TEST_CASE("each charge adds to a Poisson-Boltzmann reading what it makes alone") {
  const Molecule m = charged_chain();
  for (const auto& engine : fast_back_ends()) {
    const MeshPtr mesh = comparison_surface(*engine, m);
    for (const double padding : {12.0, 5.0}) {  // the border near the surface, where it counts
      for (const auto boundary : {espdiff::FarBoundary::kDebyeHueckel, espdiff::FarBoundary::kFocus}) {
        PoissonBoltzmannOptions options;
        options.far_boundary = boundary;
        const Lattice lattice = pb_lattice(m, 1.0, padding);
        check_against_single_charges(
            *engine,
            [&](Engine& e, const std::vector<float>& q) {
              return pb_on_device(e, molecule_of(m.positions, m.radii, q), lattice, options);
            },
            m.charges, mesh);
      }
    }
  }
}

TEST_CASE("each charge adds to a reading of Coulomb's law what it makes alone") {
  const Molecule m = charged_chain();
  Random random(94);
  const espdiff::RigidTransform to_map = random_rigid(random, 20);
  for (const auto& engine : back_ends()) {
    const MeshPtr mesh = comparison_surface(*engine, m);
    for (const bool by_distance : {false, true}) {
      espdiff::CoulombOptions options;
      options.distance_dependent = by_distance;
      check_against_single_charges(
          *engine,
          [&](Engine& e, const std::vector<float>& q) { return e.isolated_charges(m.positions, q, options, to_map); },
          m.charges, mesh);
    }
  }
}

TEST_CASE("each charge adds to a reading of Ewald's sum what it makes alone, wherever the zero lies") {
  const Molecule m = charged_chain();
  for (const auto& engine : engines_with_fourier()) {
    const MeshPtr mesh = comparison_surface(*engine, m);
    for (const NamedCell& named : {cells()[0], cells()[1]}) {
      CAPTURE(named.name);
      PmeOptions smooth = options_for(named.cell, 1.0), full = smooth, single = smooth, compatible;
      smooth.smooth_samples = full.smooth_samples = true;
      full.part = espdiff::PmePart::kFull;
      single.precision = espdiff::Precision::kSingle;
      compatible.size = {32, 32, 36};
      compatible.order = 4;
      compatible.compatible = true;
      for (const PmeOptions& options : {smooth, full, single, compatible}) {
        const MapOfCharges make = [&](Engine& e, const std::vector<float>& q) {
          return e.pme_potential(m.positions, q, named.cell, options, {}, {});
        };
        check_against_single_charges(*engine, make, m.charges, mesh);
        if (options.compatible) continue;
        const MapOfCharges in_bulk = [&](Engine& e, const std::vector<float>& q) {
          return e.zero_in_bulk(make(e, q), m.positions, 8, nullptr);
        };
        check_against_single_charges(*engine, in_bulk, m.charges, mesh);
      }
    }
  }
}

TEST_CASE("a probe adds what a charge there would, with the shape kept") {
  const Molecule m = charged_chain();
  Random random(96);
  const espdiff::RigidTransform to_map = random_rigid(random, 20);
  // A charge without radius inside another atom leaves the dielectric as it is.
  Molecule more = m;
  more.positions.push_back(m.positions[4] + Vec3d{0.3, -0.2, 0.4});
  more.radii.push_back(0);
  more.charges.assign(more.size(), 0.0F);
  more.charges.back() = 0.7F;
  for (const auto& engine : fast_back_ends()) {
    const MeshPtr mesh = comparison_surface(*engine, m);
    const std::vector<double> weights = some_weights(engine->n_vertices(mesh), 97);
    const std::size_t n = m.size();
    const auto check = [&](const GridPtr& map, const GridPtr& alone, Vec3d place) {
      const std::vector<espdiff::ProbeCharge> probes{{place, 0, 0.7F}};
      const std::vector<double> found =
          engine->contributions(map, readings_at(*engine, mesh, {weights}), probes, {}).front();
      REQUIRE(found.size() == n + 1);
      const double wanted = reading_of(*engine, alone, mesh, weights);
      CHECK(found[n] == doctest::Approx(wanted).epsilon(1e-4));
      CHECK(std::vector<double>(found.begin(), found.end() - 1) ==
            engine->contributions(map, readings_at(*engine, mesh, {weights}), {}, {}).front());
    };
    for (const auto boundary : {espdiff::FarBoundary::kDebyeHueckel, espdiff::FarBoundary::kFocus}) {
      PoissonBoltzmannOptions options;
      options.far_boundary = boundary;
      const Lattice lattice = pb_lattice(m, 1.0, 8);
      check(pb_on_device(*engine, m, lattice, options), pb_on_device(*engine, more, lattice, options),
            more.positions.back());
    }
    // Probes are in the mesh's frame, charges in the map's.
    const Vec3d here = more.positions.back(), there = to_map.apply(here);
    check(engine->isolated_charges(m.positions, m.charges, {}, to_map),
          engine->isolated_charges({there}, {0.7F}, {}, to_map), here);
    const GridPtr pb = pb_on_device(*engine, m, pb_lattice(m, 1.0, 8), {});
    CHECK(message_of([&] {
            engine->contributions(pb, readings_at(*engine, mesh, {weights}), {{{500, 0, 0}, 0, 1}}, {});
          }) == "a charge is asked about outside the potential's grid of 12 charges; give the grid a wider padding");
  }
}

TEST_CASE("contributions have the same bits at 1, 2 and 4 threads, with coefficients kept or made again") {
  const Molecule m = charged_chain();
  std::vector<double> first;
  for (const int n_threads : {1, 2, 4}) {
    for (const auto& engine : fast_back_ends(n_threads)) {
      if (engine->back_end() != "cpu") continue;
      const MeshPtr mesh = comparison_surface(*engine, m);
      const GridPtr map = pb_on_device(*engine, m, pb_lattice(m, 1.0, 8), {});
      const auto readings = readings_at(*engine, mesh, {some_weights(engine->n_vertices(mesh), 95)});
      const auto found = engine->contributions(map, readings, {}, {});
      if (first.empty()) first = found.front();
      CHECK(std::memcmp(first.data(), found.front().data(), first.size() * sizeof(double)) == 0);
      PoissonBoltzmannOptions keeping;
      keeping.keep_operator = true;
      const GridPtr keeper = pb_on_device(*engine, m, pb_lattice(m, 1.0, 8), keeping);
      for (const GridPtr& kept : {keeper, engine->without_values(keeper)}) {
        const auto again = engine->contributions(kept, readings, {}, {});
        CHECK(std::memcmp(first.data(), again.front().data(), first.size() * sizeof(double)) == 0);
      }
    }
  }
}

TEST_CASE("maps that are no sum over charges have no contributions") {
  const Molecule m = charged_chain();
  for (const auto& engine : fast_back_ends()) {
    const MeshPtr mesh = comparison_surface(*engine, m);
    std::vector<PotentialReading> readings =
        readings_at(*engine, mesh, {std::vector<double>(engine->n_vertices(mesh), 1.0)});
    PoissonBoltzmannOptions options;
    options.nonlinear = true;
    const GridPtr nonlinear = pb_on_device(*engine, m, pb_lattice(m, 1.0, 8), options);
    CHECK(message_of([&] { engine->contributions(nonlinear, readings, {}, {}); }) ==
          "the nonlinear Poisson-Boltzmann equation has no causes: its potential is not a sum over charges; take the "
          "linearized equation");
    const GridPtr given = engine->upload_map(engine->download(nonlinear), {});
    CHECK(message_of([&] { engine->contributions(given, readings, {}, {}); }) ==
          "a given potential map does not say which charges it is made of; let the potential be computed");
    const GridPtr map = engine->isolated_charges(m.positions, m.charges, {}, {});
    CHECK(message_of([&] { engine->contributions(map, readings_at(*engine, mesh, {{1.0}}), {}, {}); }) ==
          "a reading needs one weight for each point");
    const GridPtr small = pb_on_device(*engine, m, pb_lattice(m, 1.0, 4), {});
    readings[0].points[0] = readings[0].points[0] + Vec3f{500, 0, 0};
    CHECK(message_of([&] { engine->contributions(small, readings, {}, {}); }) ==
          "a reading has weight outside the potential map");
  }
}

TEST_SUITE_END();
