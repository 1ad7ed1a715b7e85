// far_charges_forms.cpp: charges spread to nodes look from afar as they do in their places. Compiled with the CPU back
// end's flags, because the engine's interface does not offer them.
#include "cuda/potential/far_charges.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "support/random.h"

using namespace espdiff_test;
using espdiff::Vec3d;
using espdiff::Vec3f;
using namespace espdiff::cpu_backend;

namespace {

/// In a ball as dense as a protein.
std::vector<PbAtom> ball_of_charges(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  const double radius = std::cbrt(static_cast<double>(n) / 0.1 * 3 / (4 * 3.14159265358979));
  std::vector<PbAtom> atoms;
  while (atoms.size() < n) {
    const Vec3d p{random.uniform(-radius, radius), random.uniform(-radius, radius), random.uniform(-radius, radius)};
    if (norm(p) < radius) atoms.push_back({p, 1.5F, static_cast<float>(random.uniform(-0.5, 0.5))});
  }
  return atoms;
}

std::vector<double> charges_of(const std::vector<PbAtom>& atoms) {
  std::vector<double> charges;
  for (const PbAtom& atom : atoms) charges.push_back(static_cast<double>(atom.charge));
  return charges;
}

/// exp(-0.1 r) / r
double screened(const Vec3d& p, const Vec3d& at) {
  const double r = norm(p - at);
  return std::exp(-0.1 * r) / r;
}

}  // namespace

TEST_CASE("charges at the nodes have the charges' sums and, 20 A away, their potential") {
  constexpr double kSpacing_A = 5, kFar_A = 20;
  const std::vector<PbAtom> atoms = ball_of_charges(3000, 5);
  const std::vector<double> charges = charges_of(atoms);
  const FarCharges far(atoms, kSpacing_A);
  REQUIRE(far.places().size() < atoms.size() / 2);
  const std::vector<float> strengths = far.spread(charges);
  REQUIRE(strengths.size() == far.places().size());
  double total = 0, of_nodes = 0, farthest = 0;
  Vec3d dipole{}, node_dipole{};
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    total += charges[i];
    dipole += charges[i] * atoms[i].position;
    farthest = std::max(farthest, norm(atoms[i].position));
  }
  for (std::size_t node = 0; node < strengths.size(); ++node) {
    of_nodes += static_cast<double>(strengths[node]);
    node_dipole += static_cast<double>(strengths[node]) * static_cast<Vec3d>(far.places()[node]);
  }
  CHECK(of_nodes == doctest::Approx(total).epsilon(1e-5));
  CHECK(norm(node_dipole - dipole) < 1e-4 * norm(dipole) + 1e-3);
  Random random(6);
  double squares = 0, errors = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Vec3d way{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const Vec3d p = ((farthest + kFar_A) / norm(way)) * way;
    double expected = 0, found = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) expected += charges[i] * screened(p, atoms[i].position);
    for (std::size_t node = 0; node < strengths.size(); ++node)
      found += static_cast<double>(strengths[node]) * screened(p, static_cast<Vec3d>(far.places()[node]));
    squares += expected * expected;
    errors += (found - expected) * (found - expected);
  }
  CHECK(std::sqrt(errors / squares) < 0.01);
}

TEST_CASE("a single charge errs by less than 0.2 % at four times the spacing") {
  std::vector<PbAtom> atoms = ball_of_charges(3000, 7);
  std::vector<double> charges(atoms.size(), 0);
  const FarCharges far(atoms, 5);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1500}, std::size_t{2999}}) {
    charges.assign(atoms.size(), 0);
    charges[i] = 1;
    const std::vector<float> strengths = far.spread(charges);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d p = atoms[i].position;
      p[axis] += 20;
      double found = 0;
      for (std::size_t node = 0; node < strengths.size(); ++node)
        found += static_cast<double>(strengths[node]) * screened(p, static_cast<Vec3d>(far.places()[node]));
      CHECK(found == doctest::Approx(screened(p, atoms[i].position)).epsilon(0.002));
    }
  }
}

TEST_CASE("gathering from the nodes is the transpose of spreading to them") {
  const std::vector<PbAtom> atoms = ball_of_charges(2000, 8);
  const std::vector<double> charges = charges_of(atoms);
  const FarCharges far(atoms, 5);
  Random random(9);
  std::vector<float> values;
  for (std::size_t node = 0; node < far.places().size(); ++node)
    values.push_back(static_cast<float>(random.uniform(-1, 1)));
  const std::vector<float> spread = far.spread(charges);
  const std::vector<double> gathered = far.gather(values);
  double at_nodes = 0, at_atoms = 0;
  for (std::size_t node = 0; node < values.size(); ++node)
    at_nodes += static_cast<double>(spread[node]) * static_cast<double>(values[node]);
  for (std::size_t i = 0; i < atoms.size(); ++i) at_atoms += charges[i] * gathered[i];
  CHECK(at_nodes == doctest::Approx(at_atoms).epsilon(1e-5));
}

TEST_CASE("few charges, and those without a spacing, stay in their places") {
  const std::vector<PbAtom> few = ball_of_charges(30, 3), many = ball_of_charges(1000, 4);
  for (const auto& [atoms, spacing_A] : {std::pair(&few, 5.0), std::pair(&many, 0.0)}) {
    const FarCharges far(*atoms, spacing_A);
    REQUIRE(far.places().size() == atoms->size());
    const std::vector<float> strengths = far.spread(charges_of(*atoms));
    for (std::size_t i = 0; i < atoms->size(); ++i) {
      CHECK(strengths[i] == (*atoms)[i].charge);
      CHECK(norm(static_cast<Vec3d>(far.places()[i]) - (*atoms)[i].position) < 1e-5);
    }
  }
  CHECK(FarCharges({}, 5).places().empty());
}
