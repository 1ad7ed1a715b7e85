// density.cpp: the Gaussian density against a double-precision sum without truncation.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "cuda/surface/back_ends.h"
#include "cuda/surface/oracles.h"
#include "cuda/surface/read_atoms.h"
#include "engine/engine.h"
#include "support/test_data.h"

using namespace espdiff_test;

namespace {

/// Largest error of every stride-th lattice point.
double largest_error(const espdiff::Grid& grid, const AtomSet& atoms, std::size_t stride) {
  double worst = 0;
  for (std::size_t p = 0; p < grid.values.size(); p += stride) {
    const double exact = density_oracle(atoms, lattice_point(grid.lattice, p));
    worst = std::max(worst, std::fabs(static_cast<double>(grid.values[p]) - exact));
  }
  return worst;
}

bool on_border(const espdiff::Lattice& lattice, std::size_t point) {
  std::size_t rest = point;
  for (const int n : lattice.size) {
    const std::size_t at = rest % static_cast<std::size_t>(n);
    if (at == 0 || at + 1 == static_cast<std::size_t>(n)) return true;
    rest /= static_cast<std::size_t>(n);
  }
  return false;
}

void check_border(const espdiff::Grid& grid) {
  float border = 0;
  for (std::size_t p = 0; p < grid.values.size(); ++p) {
    if (on_border(grid.lattice, p)) border = std::max(border, std::fabs(grid.values[p]));
  }
  CHECK(border == 0.0F);
}

}  // namespace

TEST_SUITE_BEGIN("density");

TEST_CASE("density truncation: a random cloud errs by less than 1e-3") {
  const AtomSet atoms = random_cloud(400, 2);
  for (const auto& engine : back_ends()) {
    for (const double spacing : {0.7, 1.0, 2.5}) {
      const auto grid = engine->download(engine->density(upload(*engine, atoms), spacing));
      CAPTURE(spacing);
      CHECK(largest_error(grid, atoms, 1) < 1e-3);
      check_border(grid);
    }
  }
}

TEST_CASE("density truncation: real proteins err by less than 1e-3") {
  for (const std::string name : {"pair_tim_maps/scTIM_chainA.pqr", "ref_apbs/1tca.pqr"}) {
    const auto path = real_input(name);
    if (!path) return;
    const AtomSet atoms = read_atoms(*path);
    for (const auto& engine : back_ends()) {
      const auto grid = engine->download(engine->density(upload(*engine, atoms), 1.0));
      const double worst = largest_error(grid, atoms, 61);  // a prime stride visits all positions in the rows
      std::printf("density truncation, %s, %s: largest error %.2e\n", engine->back_end().c_str(), name.c_str(), worst);
      CHECK(worst < 1e-3);
      check_border(grid);
    }
  }
}

TEST_CASE("the density at points agrees with the lattice and with the sum") {
  const AtomSet atoms = random_cloud(300, 3);
  Random random(4);
  std::vector<Vec3f> points;
  for (int n = 0; n < 3000; ++n) points.push_back(static_cast<Vec3f>(random.in_box(16)));
  for (const auto& engine : back_ends()) {
    const auto uploaded = upload(*engine, atoms);
    const std::vector<float> values = engine->density_at(uploaded, points);
    REQUIRE(values.size() == points.size());
    double worst = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
      worst = std::max(
          worst, std::fabs(static_cast<double>(values[n]) - density_oracle(atoms, static_cast<Vec3d>(points[n]))));
    }
    CHECK(worst < 1e-3);

    // Lattice and points truncate the Gaussian differently (box and ball), which leaves the terms in between.
    const auto grid = engine->download(engine->density(uploaded, 1.0));
    std::vector<Vec3f> lattice_points;
    for (std::size_t p = 0; p < grid.values.size(); ++p)
      lattice_points.push_back(static_cast<Vec3f>(lattice_point(grid.lattice, p)));
    const std::vector<float> there = engine->density_at(uploaded, lattice_points);
    float difference = 0;
    for (std::size_t p = 0; p < there.size(); ++p)
      difference = std::max(difference, std::fabs(there[p] - grid.values[p]));
    CHECK(difference < 1e-3F);
  }
}

TEST_CASE("one Gaussian on the lattice is the exponential to single precision") {
  for (const auto& engine : back_ends()) {
    const AtomSet atoms = one_gaussian({0.3, 0.4, -0.2}, 1.5);
    const auto grid = engine->download(engine->density(upload(*engine, atoms), 0.4));
    double worst = 0;
    for (std::size_t p = 0; p < grid.values.size(); ++p) {
      const Vec3d at = lattice_point(grid.lattice, p);
      if (norm(at - atoms.positions[0]) > 4.4 * 1.5) continue;  // within the cutoff
      worst = std::max(worst, std::fabs(static_cast<double>(grid.values[p]) - density_oracle(atoms, at)));
    }
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("the order of the atoms does not matter") {
  const AtomSet atoms = random_cloud(300, 5);
  AtomSet permuted;
  Random random(6);
  std::vector<std::size_t> order(atoms.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  for (const std::size_t i : order)
    permuted.add(atoms.positions[i], static_cast<double>(atoms.widths[i]), atoms.residues[i]);
  for (const auto& engine : back_ends()) {
    const auto a = engine->download(engine->density(upload(*engine, atoms), 1.0));
    const auto b = engine->download(engine->density(upload(*engine, permuted), 1.0));
    REQUIRE(a.values.size() == b.values.size());
    float worst = 0;
    for (std::size_t p = 0; p < a.values.size(); ++p) {
      worst = std::max(worst, std::fabs(a.values[p] - b.values[p]) / std::max(1.0F, a.values[p]));
    }
    CHECK(worst < 1e-6F);
  }
}

TEST_CASE("atoms of width 0 add nothing") {
  const AtomSet atoms = random_cloud(100, 7);
  AtomSet more = atoms;
  more.add({500, 0, 0}, 0);  // nor do they enlarge the lattice
  more.add({0.1, 0.2, 0.3}, 0);
  for (const auto& engine : back_ends()) {
    const auto a = engine->download(engine->density(upload(*engine, atoms), 1.0));
    const auto b = engine->download(engine->density(upload(*engine, more), 1.0));
    CHECK(a.lattice.size == b.lattice.size);
    CHECK(a.values == b.values);
  }
}

TEST_CASE("density: wrong input is refused with the value and a remedy") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& engine : back_ends()) {
    const auto message = [&](const AtomSet& atoms) { return message_of([&] { upload(*engine, atoms); }); };
    CHECK(message({}) == "no atom has a positive radius, so there is no surface; check the radii or the selection");
    CHECK(message(one_gaussian({0, 0, 0}, 0)) == message({}));
    AtomSet broken = random_cloud(5, 8);
    broken.positions[2].y = nan;
    CHECK(message(broken) == "atom 3 has a coordinate that is not finite");
    CHECK_THROWS_AS(upload(*engine, broken), espdiff::InputError);
    broken = random_cloud(5, 8);
    broken.widths.pop_back();
    CHECK_THROWS_AS(upload(*engine, broken), espdiff::InputError);

    const auto atoms = upload(*engine, random_cloud(5, 8));
    CHECK(message_of([&] { engine->density(atoms, 0); }) == "grid spacing 0 A is not a positive number; 1 is usual");
    for (const double spacing : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
      CHECK_THROWS_AS(engine->density(atoms, spacing), espdiff::InputError);
    }
    CHECK_THROWS_AS(engine->density(atoms, 1e-4), espdiff::MemoryError);
    const std::string text = message_of([&] { engine->density(atoms, 1e-4); });
    CHECK(text.find("a spacing of ") != std::string::npos);
    CHECK(text.find(" A would fit") != std::string::npos);
  }
}

TEST_SUITE_END();
