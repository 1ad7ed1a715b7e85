// rigid_domains.cpp: domains by chain, by name and by search; motions as screws; refusals.
#include "align/geometry/rigid_domains.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "made_molecule.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::MadeMolecule;
using espdiff_test::message_of;

namespace {

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

IndexPairs one_to_one(const Molecule& molecule) {
  IndexPairs pairs;
  for (std::size_t i = 0; i < molecule.size(); ++i) pairs.emplace_back(i, i);
  return pairs;
}

/// A rotation about an axis through a point, and a translation.
RigidTransform turn(Vec3d axis, double angle, Vec3d through, Vec3d shift) {
  Screw screw;
  screw.axis = (1 / norm(axis)) * axis;
  screw.angle = angle;
  screw.through = through;
  RigidTransform motion;
  for (int column = 0; column < 3; ++column) {
    Vec3d e{};
    e[column] = 1;
    const Vec3d turned = screw.turn(e, 1);
    for (int row = 0; row < 3; ++row) motion.rotation[3 * row + column] = turned[row];
  }
  motion.translation = screw.apply({}, 1) + shift;
  return motion;
}

/// Four times 30 residues, each stretch a helix in its own direction, in chains A, A, A, B.
Molecule four_stretches() {
  MadeMolecule made;
  for (int stretch = 0; stretch < 4; ++stretch)
    made.peptide(stretch == 3 ? "B" : "A", 30 * stretch + 1, "ACDEFGHIKLMNPQRSTVWYACDEFGHIKL");
  Molecule& m = made.molecule;
  for (std::size_t i = 0; i < m.size(); ++i) {
    const int residue = m.atoms[i].residue, stretch = residue / 30;
    const double along = 1.5 * (residue % 30) + 0.3 * static_cast<double>(i % 5),
                 phi = 1.745 * residue + 0.7 * static_cast<double>(i % 5);
    const Vec3d p{2.3 * std::cos(phi), 2.3 * std::sin(phi), along};
    m.positions[i] = stretch % 2 == 0 ? Vec3d{p.x + 12.0 * stretch, p.y, p.z} : Vec3d{p.z, p.x + 12.0 * stretch, p.y};
  }
  return m;
}

/// Each residue's atoms moved by `motion(residue)`, with some noise.
template <typename Motion>
Molecule moved(Molecule m, Motion motion, double noise) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;  // of deviation 1: 0 is none
  for (std::size_t i = 0; i < m.size(); ++i) {
    m.positions[i] = motion(m.atoms[i].residue).apply(m.positions[i]);
    if (noise > 0) m.positions[i] += noise * Vec3d{normal(random), normal(random), normal(random)};
  }
  return m;
}

/// Residues outside the expected domain.
std::size_t n_misplaced(const std::vector<RigidDomain>& domains, const std::vector<std::size_t>& expected) {
  std::vector<std::size_t> found(expected.size(), 99);
  for (std::size_t k = 0; k < domains.size(); ++k) {
    for (const std::size_t r : domains[k].residues) found[r] = k;
  }
  std::size_t n = 0;
  for (std::size_t r = 0; r < found.size(); ++r) n += found[r] == expected[r] ? 0 : 1;
  return n;
}

}  // namespace

TEST_SUITE_BEGIN("rigid_domains");

TEST_CASE("domains that move as rigid bodies are found, the largest first, with their motions") {
  const Molecule source = four_stretches();
  // Residues 0-59 stay, 60-89 and 90-119 rotate differently: domains of 60, 30 and 30 residues.
  const RigidTransform second = turn({1, 2, 0}, 0.9, {20, 5, 0}, {1, 2, 3}),
                       third = turn({0, 1, 3}, -0.7, {}, {9, 0, 4});
  for (const double noise : {0.0, 0.4}) {
    const Molecule target = moved(
        source, [&](int r) { return r < 60   ? RigidTransform{}
                                    : r < 90 ? second
                                             : third; }, noise);
    const auto domains = find_domains("auto", source, target, one_to_one(source));
    REQUIRE(domains.size() == 3);
    std::vector<std::size_t> expected(120, 0);
    const bool turned_first = domains[1].residues.front() < 90;
    for (std::size_t r = 60; r < 120; ++r) expected[r] = (r < 90) == turned_first ? 1 : 2;
    CAPTURE(noise);
    CHECK(n_misplaced(domains, expected) <= (noise == 0 ? 2U : 6U));  // beside a hinge either motion may suit
    const RigidDomain& domain = domains[turned_first ? 1 : 2];
    CHECK(domain.rmsd_A < 0.1 + 2 * noise);
    CHECK(norm(domain.motion.apply(source.positions[360]) - second.apply(source.positions[360])) < 0.2 + noise);
  }
}

TEST_CASE("a molecule that moves as a whole is one domain with all residues") {
  const Molecule source = four_stretches();
  const RigidTransform motion = turn({1, 1, 1}, 2.0, {3, 0, 0}, {5, 5, 5});
  const Molecule target = moved(
      source, [&](int) { return motion; }, 0.5);
  const auto domains = find_domains("auto", source, target, one_to_one(source));
  REQUIRE(domains.size() == 1);
  CHECK(domains[0].residues.size() == 120);
  CHECK(domains[0].n_atoms == source.size());
}

TEST_CASE("each chain is a domain unless it is too small to have a motion") {
  MadeMolecule made;
  made.peptide("A", 1, "ACDEF");
  made.peptide("B", 1, "GHIKL");
  made.residue("C", 1, "NA", {"NA"});
  const Molecule& source = made.molecule;
  const RigidTransform shift = turn({0, 0, 1}, 0.3, {}, {10, 0, 0});
  const Molecule target = moved(
      source, [&](int r) { return r < 5 ? RigidTransform{} : shift; }, 0);
  const auto domains = find_domains("chains", source, target, one_to_one(source));
  REQUIRE(domains.size() == 2);
  CHECK(domains[1].residues == std::vector<std::size_t>{5, 6, 7, 8, 9});
  CHECK(domains[1].rmsd_A < 1e-9);
  CHECK(norm(domains[1].motion.apply({1, 2, 3}) - shift.apply({1, 2, 3})) < 1e-9);
}

TEST_CASE("domains of residues that the user names, with and without chains") {
  MadeMolecule made;
  made.peptide("A", 1, "ACDEFGHI");
  made.peptide("B", 1, "ACDEFGHI");
  const Molecule& m = made.molecule;
  const auto residues_of = [&](const std::string& text) {
    std::vector<std::string> all;
    for (const RigidDomain& domain : find_domains(text, m, m, one_to_one(m)))
      all.push_back(residue_ranges(m, domain.residues));
    return all;
  };
  using Texts = std::vector<std::string>;
  CHECK(residues_of("A:1-3,5/B:2-4") == Texts{"A:1-3,5", "B:2-4"});
  CHECK(residues_of("B:1-2,7-8/A:4") == Texts{"B:1-2,7-8", "A:4"});
  CHECK(residues_of("2-3") == Texts{"A:2-3,B:2-3"});
  CHECK(residues_of("none").empty());
}

TEST_CASE("domains that cannot be read, found or fitted are refused with the remedy") {
  MadeMolecule made("made.pdb");
  made.peptide("A", 1, "ACDEF");
  made.residue("A", 9, "NA", {"NA"});
  const Molecule& m = made.molecule;
  const auto refusal = [&](const std::string& text) {
    return message_of([&] { find_domains(text, m, m, one_to_one(m)); });
  };
  const std::string remedy = "; give as-needed, none, local, chains, auto, or residues such as A:1-29,68-117/A:30-67";
  CHECK(refusal("") == "domains: '' has an unreadable range of residues, ''" + remedy);
  CHECK(refusal("A:1-x") == "domains: 'A:1-x' has an unreadable range of residues, 'A:1-x'" + remedy);
  CHECK(refusal("domain") == "domains: 'domain' has an unreadable range of residues, 'domain'" + remedy);
  CHECK(refusal("1-3/") == "domains: '1-3/' has an unreadable range of residues, ''" + remedy);
  CHECK(refusal("5-2") == "domains: '5-2' has a range that ends before it starts, '5-2'" + remedy);
  CHECK(refusal("B:1-3") == "domains: 'B:1-3' names residues B:1-3, and made.pdb has none of them" + remedy);
  CHECK(refusal("1-3/3-5") == "domains: '1-3/3-5' names residue A:3 of made.pdb in two domains" + remedy);
  CHECK(
      refusal("1-5/9") ==
      "domains: '1-5/9' has a domain, A:9, in which only 1 atoms pair or all lie on a line, so that its motion is not "
      "known" +
          remedy);
  CHECK_NOTHROW(check_domains("-4--2,1"));
}

TEST_CASE("a motion as a screw has the same end, and its fractions add up") {
  const Vec3d p{4, -3, 7};
  for (const double angle : {0.0, 1e-9, 1e-3, 1.0, 3.1, 3.141592653589793}) {
    const RigidTransform motion = turn({1, -2, 2}, angle, {5, 1, 0}, {0.3, 2, -1});
    const Screw screw = screw_of(motion);
    CAPTURE(angle);
    CHECK(norm(screw.apply(p, 1) - motion.apply(p)) < 1e-7);
    CHECK(norm(screw.apply(screw.apply(p, 0.3), 0.7) - screw.apply(p, 1)) < 1e-9);
    CHECK(norm(screw.apply(screw.apply(p, 1), -1) - p) < 1e-9);
    const double h = 1e-5;
    const Vec3d slope = (1 / (2 * h)) * (screw.apply(p, 0.4 + h) - screw.apply(p, 0.4 - h));
    CHECK(norm(screw.velocity_at(screw.apply(p, 0.4)) - slope) < 1e-6);
  }
}

TEST_SUITE_END();
