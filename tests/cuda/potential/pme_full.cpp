// pme_full.cpp: the whole of Ewald's sum against a direct one with its real-space part, isolated charges against
// Coulomb's law, and the zero in the bulk.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

#include "cuda/potential/ewald_oracle.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Grid;
using espdiff::GridPtr;

namespace {

/// C sum q erfc(beta r) / r over the images within 9 / beta, less its mean over the cell; in double precision.
double direct_part(const Charges& atoms, const PmeCell& cell, double beta, const Vec3d& at) {
  const double range = 9 / beta, volume = dot(cell.edges[0], cross(cell.edges[1], cell.edges[2]));
  int reach[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double height = volume / norm(cross(cell.edges[(axis + 1) % 3], cell.edges[(axis + 2) % 3]));
    reach[axis] = static_cast<int>(std::ceil(range / height)) + 2;
  }
  double sum = 0, net = 0;
  for (std::size_t n = 0; n < atoms.positions.size(); ++n) {
    net += static_cast<double>(atoms.charges[n]);
    for (int i = -reach[0]; i <= reach[0]; ++i) {
      for (int j = -reach[1]; j <= reach[1]; ++j) {
        for (int k = -reach[2]; k <= reach[2]; ++k) {
          const Vec3d image = atoms.positions[n] + static_cast<double>(i) * cell.edges[0] +
                              static_cast<double>(j) * cell.edges[1] + static_cast<double>(k) * cell.edges[2];
          const double r = norm(at - image);
          sum += static_cast<double>(atoms.charges[n]) * std::erfc(beta * r) / r;
        }
      }
    }
  }
  return kCoulombInKt * (sum - kPi * net / (beta * beta * volume));
}

/// Points 1 A and more from all images of all charges.
std::vector<Vec3d> points_outside(const Charges& atoms, const PmeCell& cell, std::size_t n) {
  Random random(31);
  std::vector<Vec3d> points;
  while (points.size() < n) {
    Vec3d p = cell.centre;
    for (const Vec3d& edge : cell.edges) p += random.uniform(-0.9, 0.9) * edge;
    bool near = false;
    for (const Vec3d& atom : atoms.positions) {
      for (int image = 0; image < 125; ++image) {
        const Vec3d shift = static_cast<double>(image % 5 - 2) * cell.edges[0] +
                            static_cast<double>(image / 5 % 5 - 2) * cell.edges[1] +
                            static_cast<double>(image / 25 - 2) * cell.edges[2];
        near = near || norm(p - atom - shift) < 1;
      }
    }
    if (!near) points.push_back(p);
  }
  return points;
}

/// The map's samples at points, by a lattice of one point each.
std::vector<double> samples_at(Engine& engine, const GridPtr& map, const std::vector<Vec3d>& points) {
  std::vector<double> values;
  for (const Vec3d& p : points) {
    const espdiff::Lattice one{{1, 1, 1}, p, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    values.push_back(static_cast<double>(engine.download(engine.resample(map, one)).values[0]));
  }
  return values;
}

PmeOptions full(PmeOptions options) {
  options.part = espdiff::PmePart::kFull;
  options.smooth_samples = true;
  return options;
}

}  // namespace

TEST_SUITE_BEGIN("pme_full");

TEST_CASE(
    "the full sum is the direct Ewald sum with its real-space part, in cells of three shapes, with a net charge") {
  for (const auto& engine : engines_with_fourier()) {
    for (const NamedCell& named : cells()) {
      const Charges atoms = random_charges(named.cell, 60, 41);
      const std::vector<Vec3d> points = points_outside(atoms, named.cell, 40);
      const PmeOptions options = full(options_for(named.cell, 1.0));
      const GridPtr map = engine->pme_potential(atoms.positions, atoms.charges, named.cell, options, {}, {});
      std::vector<double> exact = direct_ewald(atoms, named.cell, options.ewald_factor, points);
      for (std::size_t i = 0; i < points.size(); ++i)
        exact[i] += direct_part(atoms, named.cell, options.ewald_factor, points[i]);
      const double error = relative_rms(samples_at(*engine, map, points), exact);
      MESSAGE(named.name, ": relative rms error ", error);
      CHECK(error < 1e-4);
    }
  }
}

TEST_CASE("the full sum does not depend on how it is divided") {
  const PmeCell cell = cells()[1].cell;
  const Charges atoms = random_charges(cell, 60, 42);
  const std::vector<Vec3d> points = points_outside(atoms, cell, 40);
  for (const auto& engine : engines_with_fourier()) {
    std::vector<double> first;
    for (const double beta : {0.2, 0.25, 0.4}) {
      PmeOptions options = full(options_for(cell, 0.7));
      options.ewald_factor = beta;
      const std::vector<double> values =
          samples_at(*engine, engine->pme_potential(atoms.positions, atoms.charges, cell, options, {}, {}), points);
      if (first.empty()) first = values;
      CAPTURE(beta);
      CHECK(relative_rms(values, first) < 2e-4);
    }
  }
}

TEST_CASE("the full sum has the same bits for 1, 2 and 4 threads and for any order of the atoms") {
  const PmeCell cell = cells()[2].cell;
  const Charges atoms = random_charges(cell, 200, 43);
  Charges turned = atoms;
  std::reverse(turned.positions.begin(), turned.positions.end());
  std::reverse(turned.charges.begin(), turned.charges.end());
  const espdiff::Lattice lattice{{9, 8, 7}, {1, 2, 3}, {{{1.3, 0, 0}, {0, 1.1, 0}, {0, 0, 0.9}}}};
  std::vector<float> first;
  for (const int n_threads : {1, 2, 4}) {
    for (const auto& engine : engines_with_fourier(n_threads)) {
      if (engine->back_end() != "cpu") continue;
      for (const Charges* input : {&atoms, static_cast<const Charges*>(&turned)}) {
        const GridPtr map =
            engine->pme_potential(input->positions, input->charges, cell, full(options_for(cell, 1.0)), {}, {});
        const std::vector<float> values = engine->download(engine->resample(map, lattice)).values;
        if (first.empty()) first = values;
        CHECK(std::memcmp(values.data(), first.data(), first.size() * sizeof(float)) == 0);
      }
    }
  }
}

TEST_CASE("the full sum with PMEPot's numbers is refused") {
  const PmeCell cell = cells()[0].cell;
  const Charges atoms = random_charges(cell, 10, 44);
  for (const auto& engine : engines_with_fourier()) {
    PmeOptions options = options_for(cell, 1.0, 4);
    options.size = {32, 32, 32};
    options.compatible = true;
    options.part = espdiff::PmePart::kFull;
    CHECK(message_of([&] { engine->pme_potential(atoms.positions, atoms.charges, cell, options, {}, {}); }) ==
          "the full sum with `compatible`: PMEPot gives the smooth part only; leave one out");
  }
}

TEST_CASE("isolated charges are Coulomb's law where they are sampled, turned with their frame") {
  const Charges atoms = random_charges(cells()[0].cell, 50, 45);
  const std::vector<Vec3d> points = points_outside(atoms, cells()[0].cell, 20);
  Random random(46);
  const espdiff::RigidTransform to_map = random_rigid(random, 20);
  for (const auto& engine : back_ends()) {
    for (const bool by_distance : {false, true}) {
      espdiff::CoulombOptions options;
      options.dielectric = 4;
      options.distance_dependent = by_distance;
      const std::vector<double> values =
          samples_at(*engine, engine->isolated_charges(atoms.positions, atoms.charges, options, to_map), points);
      std::vector<double> exact;
      for (const Vec3d& p : points) {
        double sum = 0;
        for (std::size_t i = 0; i < atoms.positions.size(); ++i) {
          const double r = std::max(norm(to_map.apply(p) - atoms.positions[i]), 0.5);
          sum += static_cast<double>(atoms.charges[i]) / (by_distance ? r * r : r);
        }
        exact.push_back(kCoulombInKt * sum / 4);
      }
      CHECK(relative_rms(values, exact) < 1e-6);
    }
    const GridPtr map = engine->isolated_charges(atoms.positions, atoms.charges, {}, {});
    CHECK(message_of([&] { engine->download(map); }) ==
          "isolated charges have no lattice of their own; resample them on one");
  }
}

TEST_CASE("the zero in the bulk is the mean over the points that are far from the solute's images") {
  const PmeCell cell = cells()[1].cell;
  const Charges atoms = random_charges(cell, 100, 47);
  // A solute at the cell's border, so that its images count.
  const std::vector<Vec3d> solute{cell.centre + 0.5 * cell.edges[0], cell.centre + 0.4 * cell.edges[1]};
  constexpr double kDistance_A = 10;
  for (const auto& engine : engines_with_fourier()) {
    for (const bool smooth_samples : {false, true}) {
      PmeOptions options = options_for(cell, 1.5);
      options.smooth_samples = smooth_samples;
      const GridPtr map = engine->pme_potential(atoms.positions, atoms.charges, cell, options, {}, {});
      const Grid plain = engine->download(map);
      double sum = 0;
      std::size_t n = 0;
      for (std::size_t p = 0; p < plain.values.size(); ++p) {
        bool near = false;
        for (const Vec3d& atom : solute) {
          for (int image = 0; image < 125; ++image) {
            const Vec3d shift = static_cast<double>(image % 5 - 2) * cell.edges[0] +
                                static_cast<double>(image / 5 % 5 - 2) * cell.edges[1] +
                                static_cast<double>(image / 25 - 2) * cell.edges[2];
            near = near || norm(lattice_point(plain.lattice, p) - atom - shift) <= kDistance_A;
          }
        }
        if (near) continue;
        sum += static_cast<double>(plain.values[p]);
        ++n;
      }
      espdiff::BulkZero report;
      const GridPtr moved = engine->zero_in_bulk(map, solute, kDistance_A, &report);
      const double mean = sum / static_cast<double>(n);
      CHECK(report.fraction == doctest::Approx(static_cast<double>(n) / static_cast<double>(plain.values.size())));
      CHECK(report.mean_there == doctest::Approx(mean).epsilon(1e-4));
      const Grid after = engine->download(moved);
      CHECK(static_cast<double>(after.values[7] - plain.values[7]) == doctest::Approx(-mean).epsilon(1e-3));
      // No point is 100 A from the solute: the zero stays.
      engine->zero_in_bulk(map, solute, 100, &report);
      CHECK(report.fraction == 0);
    }
  }
}

TEST_SUITE_END();
