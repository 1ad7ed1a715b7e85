// pme.cpp: the particle-mesh potential against a known constant and a direct Ewald sum, and its symmetries.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "cuda/potential/ewald_oracle.h"
#include "engine/engine.h"
#include "engine/potential_stage.h"

using namespace espdiff_test;
using espdiff::Grid;

namespace {

double mean_of(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}
double rms_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v) * static_cast<double>(v);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

TEST_SUITE_BEGIN("pme");

TEST_CASE("rock salt has Madelung's constant") {
  // 1.74756459: E. Madelung, Phys. Z. 19, 524 (1918); the digits are those of any table.
  constexpr double kMadelung = 1.747564594633, kEdge = 5.64, kBeta = 0.8;
  Charges ions;
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
    ions.positions.push_back({0.5 * kEdge * x, 0.5 * kEdge * y, 0.5 * kEdge * z});
    ions.charges.push_back((x + y + z) % 2 == 0 ? 1.0F : -1.0F);
  }
  PmeCell cell = cell_of({kEdge, kEdge, kEdge}, {90, 90, 90}, {});
  PmeOptions options;
  options.size = {25, 25, 25};  // odd: the middle point lies on the first ion
  options.order = 8;
  options.ewald_factor = kBeta;
  // The rest of the potential at the first ion: the others' bare parts minus its own Gaussian.
  double rest = -2 * kBeta / std::sqrt(kPi);
  for (int i = -5; i <= 5; ++i) {
    for (int j = -5; j <= 5; ++j) {
      for (int k = -5; k <= 5; ++k) {
        const double r = 0.5 * kEdge * std::sqrt(i * i + j * j + k * k);
        if (r > 0) rest += ((i + j + k) % 2 == 0 ? 1 : -1) * std::erfc(kBeta * r) / r;
      }
    }
  }
  for (const auto& engine : engines_with_fourier()) {
    const Grid map = pme_map(*engine, ions, cell, in_double(options));
    const double at_ion = static_cast<double>(map.values[12 + 25 * (12 + 25 * 12)]) / kCoulombInKt + rest;
    CHECK(at_ion * 0.5 * kEdge == doctest::Approx(-kMadelung).epsilon(1e-6));
  }
}

TEST_CASE("order 6 at 1 A errs by less than 1e-4 of the rms potential, in cells of three shapes, charged or neutral") {
  for (const auto& engine : engines_with_fourier()) {
    for (const NamedCell& named : cells()) {
      const PmeCell& cell = named.cell;
      for (const bool neutral : {true, false}) {
        const Charges atoms = random_charges(cell, 250, 7, neutral);
        const PmeOptions options = options_for(cell, 1.0);
        CAPTURE(named.name);
        CAPTURE(neutral);
        CHECK(pme_error(*engine, atoms, cell, options) < 1e-4);
        CHECK(pme_error(*engine, atoms, cell, in_double(options)) < 1e-4);
      }
    }
  }
}

TEST_CASE("the error falls with the order, and with the spacing to the order's power") {
  const PmeCell cell = cells()[1].cell;
  const Charges atoms = random_charges(cell, 120, 8);
  for (const auto& engine : engines_with_fourier()) {
    double previous = 1;
    for (int order = 4; order <= 8; ++order) {
      const double coarse = pme_error(*engine, atoms, cell, in_double(options_for(cell, 2.0, order)), 60);
      const double fine = pme_error(*engine, atoms, cell, in_double(options_for(cell, 1.0, order)), 60);
      const double slope = std::log2(coarse / fine);
      CAPTURE(order);
      CAPTURE(coarse);
      CAPTURE(fine);
      CHECK(slope > order - 1.0);
      CHECK(slope < order + 2.0);
      CHECK(fine < std::max(0.5 * previous, 3e-8));  // values are handed out in single precision
      previous = fine;
    }
  }
}

TEST_CASE("single precision agrees with double to a few units of its last place") {
  for (const auto& engine : engines_with_fourier()) {
    for (const NamedCell& named : cells()) {
      const PmeCell& cell = named.cell;
      const Charges atoms = random_charges(cell, 300, 9);
      const PmeOptions options = options_for(cell, 1.0);
      CAPTURE(named.name);
      CHECK(relative_max(pme_map(*engine, atoms, cell, options).values,
                         pme_map(*engine, atoms, cell, in_double(options)).values) < 3e-6);
    }
  }
}

TEST_CASE("the same bits for 1, 2 and 4 threads, on repetition, and for any order of the atoms") {
  const PmeCell cell = cells()[2].cell;
  const Charges atoms = random_charges(cell, 400, 10);
  Charges turned = atoms;
  std::reverse(turned.positions.begin(), turned.positions.end());
  std::reverse(turned.charges.begin(), turned.charges.end());
  std::vector<float> first;
  for (const int n_threads : {1, 2, 4}) {
    for (const auto& engine : engines_with_fourier(n_threads)) {
      if (engine->back_end() != "cpu") continue;
      for (const Charges* input : std::initializer_list<const Charges*>{&atoms, &turned, &atoms}) {
        const std::vector<float> values = pme_map(*engine, *input, cell, options_for(cell, 1.0)).values;
        if (first.empty()) first = values;
        REQUIRE(values.size() == first.size());
        CHECK(std::memcmp(values.data(), first.data(), first.size() * sizeof(float)) == 0);
      }
    }
  }
}

TEST_CASE("atoms in one row and at one place along it add up the same in any order") {
  const PmeCell cell = cell_of({30, 30, 30}, {90, 90, 90}, {});
  Charges atoms;
  for (int i = 0; i < 600; ++i) {  // all within one row of the grid; a third at one x, some of no charge
    const double part = 0.001 * ((i * 7919) % 600);
    atoms.positions.push_back({i % 3 == 0 ? 2.5 : 2.3 + 0.5 * part, 1.2 + 0.4 * part, 3.3 - 0.4 * part});
    atoms.charges.push_back(i % 11 == 0 ? 0.0F : 0.1F * static_cast<float>(i % 13 - 6));
  }
  Charges turned = atoms;
  std::reverse(turned.positions.begin(), turned.positions.end());
  std::reverse(turned.charges.begin(), turned.charges.end());
  Charges charged;
  for (std::size_t i = 0; i < atoms.charges.size(); ++i) {
    if (atoms.charges[i] == 0) continue;
    charged.positions.push_back(atoms.positions[i]);
    charged.charges.push_back(atoms.charges[i]);
  }
  for (const auto& engine : engines_with_fourier()) {
    CAPTURE(engine->back_end());
    const std::vector<float> first = pme_map(*engine, atoms, cell, options_for(cell, 1.0)).values;
    for (const Charges* other : {&turned, &charged}) {
      const std::vector<float> values = pme_map(*engine, *other, cell, options_for(cell, 1.0)).values;
      REQUIRE(values.size() == first.size());
      CHECK(std::memcmp(values.data(), first.data(), first.size() * sizeof(float)) == 0);
    }
  }
}

TEST_CASE("back ends agree") {
  const auto engines = engines_with_fourier();
  const PmeCell cell = cells()[1].cell;
  const Charges atoms = random_charges(cell, 300, 11);
  for (std::size_t e = 1; e < engines.size(); ++e) {
    for (const PmeOptions& options : {options_for(cell, 1.0), in_double(options_for(cell, 1.3, 5))}) {
      CHECK(relative_max(pme_map(*engines[e], atoms, cell, options).values,
                         pme_map(*engines[0], atoms, cell, options).values) < 2e-6);
    }
  }
}

TEST_CASE("moving all atoms by grid steps moves the map by as many points") {
  for (const auto& engine : engines_with_fourier()) {
    for (const NamedCell& named : cells()) {
      const PmeCell& cell = named.cell;
      const Charges atoms = random_charges(cell, 200, 12);
      const PmeOptions options = options_for(cell, 1.0);
      const Grid map = pme_map(*engine, atoms, cell, options);
      const std::array<int, 3> by{3, 11, options.size[2] - 2};
      Charges shifted = atoms;
      for (Vec3d& p : shifted.positions) {
        for (std::size_t axis = 0; axis < 3; ++axis) p += static_cast<double>(by[axis]) * map.lattice.step[axis];
      }
      const Grid moved_map = pme_map(*engine, shifted, cell, options);
      std::vector<float> expected(map.values.size());
      const auto [nx, ny, nz] = options.size;
      for (int i = 0; i < static_cast<int>(map.values.size()); ++i) {
        const int x = (i % nx + by[0]) % nx, y = (i / nx % ny + by[1]) % ny, z = (i / (nx * ny) + by[2]) % nz;
        expected[static_cast<std::size_t>(x + nx * (y + ny * z))] = map.values[static_cast<std::size_t>(i)];
      }
      CAPTURE(named.name);
      CHECK(relative_max(moved_map.values, expected) < 2e-6);
    }
  }
}

TEST_CASE("rotating molecule and cell together changes nothing; doubling the charges doubles the potential") {
  Random random(13);
  for (const auto& engine : engines_with_fourier()) {
    for (const NamedCell& named : cells()) {
      const PmeCell& cell = named.cell;
      const Charges atoms = random_charges(cell, 200, 14);
      const PmeOptions options = options_for(cell, 1.0);
      const Grid map = pme_map(*engine, atoms, cell, options);
      const espdiff::RigidTransform turn = random_rigid(random, 30);
      PmeCell turned_cell{turn.apply(cell.centre), {}};
      for (std::size_t axis = 0; axis < 3; ++axis) turned_cell.edges[axis] = turn.rotate(cell.edges[axis]);
      Charges turned = atoms, doubled = atoms;
      for (Vec3d& p : turned.positions) p = turn.apply(p);
      for (float& q : doubled.charges) q *= 2;
      const Grid turned_map = pme_map(*engine, turned, turned_cell, options);
      CAPTURE(named.name);
      CHECK(relative_max(turned_map.values, map.values) < 2e-6);
      CHECK(norm(turned_map.lattice.origin - turn.apply(map.lattice.origin)) < 1e-9);
      const Grid twice = pme_map(*engine, doubled, cell, options);
      std::size_t n_other = 0;
      for (std::size_t i = 0; i < map.values.size(); ++i) n_other += twice.values[i] == 2 * map.values[i] ? 0 : 1;
      CHECK(n_other == 0);
    }
  }
}

TEST_CASE("potentials add up; their mean is zero, also with a net charge") {
  const PmeCell cell = cells()[0].cell;
  for (const auto& engine : engines_with_fourier()) {
    const PmeOptions options = options_for(cell, 1.2, 5);
    const Charges a = random_charges(cell, 150, 15), b = random_charges(cell, 90, 16);
    Charges both = a;
    both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
    both.charges.insert(both.charges.end(), b.charges.begin(), b.charges.end());
    std::vector<float> sum = pme_map(*engine, a, cell, options).values;
    const std::vector<float> second = pme_map(*engine, b, cell, options).values;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += second[i];
    CHECK(relative_max(pme_map(*engine, both, cell, options).values, sum) < 2e-6);
    Charges positive = a;
    for (float& q : positive.charges) q = std::fabs(q);
    const std::vector<float> charged = pme_map(*engine, positive, cell, options).values;
    CHECK(std::fabs(mean_of(charged)) < 1e-5 * rms_of(charged));
  }
}

TEST_CASE("grid sizes that are odd, prime or as small as the order") {
  const PmeCell cell = cell_of({9, 10, 11}, {90, 80, 100}, {});
  const Charges atoms = random_charges(cell, 40, 17);
  for (const auto& engine : engines_with_fourier()) {
    for (const auto& size : {std::array<int, 3>{6, 7, 8}, {11, 13, 17}, {15, 10, 9}, {19, 6, 31}}) {
      PmeOptions options;
      options.size = size;
      options.ewald_factor = 0.2;
      CAPTURE(size[0]);
      CHECK(pme_error(*engine, atoms, cell, in_double(options), 60) < 0.03);
      CHECK(pme_error(*engine, atoms, cell, options, 60) < 0.03);
    }
  }
}

TEST_SUITE_END();
