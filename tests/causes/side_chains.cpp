// side_chains.cpp: placements of side chains: their geometry, what clashes, and the draws.
#include "causes/side_chains.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "align/made_molecule.h"
#include "causes/chi_angles.h"

using namespace espdiff_test;
using namespace espdiff;  // NOLINT: a test

namespace {

/// A lysine in a zigzag of tetrahedral angles, its end charged; its B factor is that of a place poorly known.
Molecule lysine() {
  MadeMolecule made;
  made.residue("A", 7, "LYS", {"N", "CA", "C", "O", "CB", "CG", "CD", "CE", "NZ"});
  Molecule& m = made.molecule;
  const double step = 1.53 * std::sin(0.97), up = 1.53 * std::cos(0.97);
  const std::size_t zigzag[] = {0, 1, 4, 5, 6, 7, 8};
  for (std::size_t i = 0; i < 7; ++i) m.positions[zigzag[i]] = {step * static_cast<double>(i), i % 2 == 0 ? 0 : up, 0};
  m.positions[2] = m.positions[1] + Vec3d{-0.5, 0.7, 1.25};
  m.positions[3] = m.positions[2] + Vec3d{-0.2, 0.3, 1.17};
  for (std::size_t i = 0; i < m.size(); ++i) {
    m.atoms[i].element = m.atoms[i].name.substr(0, 1);
    m.charges.push_back(i == 8 ? 1.0F : 0.0F);
  }
  return m;
}

std::vector<ResidueChange> poorly_known_everywhere(std::size_t n) {
  std::vector<ResidueChange> changes(n);
  for (std::size_t i = 0; i < n; ++i) {
    changes[i].source = changes[i].target = static_cast<std::int32_t>(i);
    changes[i].in_source.relative_b = changes[i].in_target.relative_b = 3;
  }
  return changes;
}

std::vector<SideChainPlacements> placements_of(const Molecule& m, bool known = false) {
  std::vector<ResidueChange> changes = poorly_known_everywhere(m.residues.size());
  if (known)
    for (ResidueChange& change : changes) change.in_source.relative_b = 1;
  return side_chain_placements(m, changes, false, std::vector<std::uint8_t>(changes.size(), 1), m.charges);
}

}  // namespace

TEST_CASE("side chains turn about their bonds: lengths stay, angles are those of the grid") {
  const Molecule m = lysine();
  const auto placed = placements_of(m);
  REQUIRE(placed.size() == 1);
  const SideChainPlacements& chain = placed.front();
  REQUIRE(chain.atoms == std::vector<std::size_t>{5, 6, 7, 8});
  CHECK(chain.positions.size() + chain.n_refused == 82);
  CHECK(chain.positions.size() > 20);
  for (std::size_t p = 0; p < chain.positions.size(); ++p) {
    std::vector<Vec3d> at{m.positions[4]};  // CB lies on the axis
    at.insert(at.end(), chain.positions[p].begin(), chain.positions[p].end());
    for (std::size_t i = 1; i < at.size(); ++i)
      CHECK(norm(at[i] - at[i - 1]) == doctest::Approx(norm(m.positions[i + 4] - m.positions[i + 3])));
    const double chi[] = {dihedral(m.positions[0], m.positions[1], at[0], at[1]),
                          dihedral(m.positions[1], at[0], at[1], at[2]), dihedral(at[0], at[1], at[2], at[3]),
                          dihedral(at[1], at[2], at[3], at[4])};
    for (std::size_t k = 0; k < 4; ++k) CHECK(std::fabs(std::remainder(chi[k] - chain.angles[p][k], 360.0)) < 1e-6);
  }
}

TEST_CASE("side chains that are known, inside, or without charges stay in place") {
  Molecule m = lysine();
  CHECK(placements_of(m, true).empty());
  CHECK(side_chain_placements(m, poorly_known_everywhere(1), false, {0}, m.charges).empty());
  m.charges.assign(m.size(), 0.0F);
  CHECK(placements_of(m).empty());
}

TEST_CASE("placements that clash with what stays in place are refused") {
  Molecule m = lysine();
  const std::size_t n_free = placements_of(m).front().positions.size();
  // A wall of atoms on one side.
  MadeMolecule wall;
  wall.molecule = m;
  wall.residue("B", 1, "LIG", std::vector<std::string>(25, "C1"));
  Molecule& both = wall.molecule;
  both.charges.resize(both.size(), 0.0F);
  for (std::size_t i = 0; i < 25; ++i) {
    both.positions[m.size() + i] = {2.5 * static_cast<double>(i % 5), 2.5 * static_cast<double>(i / 5) - 5, -3.2};
    both.atoms[m.size() + i].element = "C";
  }
  const auto placed = placements_of(both);
  REQUIRE(placed.size() == 1);
  CHECK(placed.front().positions.size() < n_free);
  for (std::size_t p = 1; p < placed.front().positions.size(); ++p) {
    for (const Vec3d at : placed.front().positions[p]) {
      for (std::size_t i = m.size(); i < both.size(); ++i) CHECK(norm(at - both.positions[i]) >= kClash_A);
    }
  }
}

TEST_CASE("draws of placements are reproducible, and neighbours do not clash in them") {
  Molecule m = lysine();
  MadeMolecule two;
  two.molecule = m;
  two.residue("A", 8, "LYS", {"N", "CA", "C", "O", "CB", "CG", "CD", "CE", "NZ"});
  Molecule& both = two.molecule;
  for (std::size_t i = 0; i < m.size(); ++i) {
    both.positions[m.size() + i] = m.positions[i] + Vec3d{0, 0, -5};
    both.atoms[m.size() + i].element = m.atoms[i].element;
    both.charges.push_back(m.charges[i]);
  }
  const auto placed = placements_of(both);
  REQUIRE(placed.size() == 2);
  const auto draws = draw_placements(both, placed, 300, 5, false);
  CHECK(draws == draw_placements(both, placed, 300, 5, false));
  CHECK(draws != draw_placements(both, placed, 300, 6, false));
  CHECK(draws != draw_placements(both, placed, 300, 5, true));
  std::vector<std::size_t> first;
  for (const auto& draw : draws) {
    for (const Vec3d a : placed[0].positions[draw[0]]) {
      for (const Vec3d b : placed[1].positions[draw[1]]) CHECK(norm(a - b) >= kPolarClash_A);
    }
    first.push_back(draw[0]);
  }
  std::sort(first.begin(), first.end());
  first.erase(std::unique(first.begin(), first.end()), first.end());
  CHECK(first.size() > placed[0].positions.size() / 2);  // all are drawn, in the long run
}
