// make_whole.cpp: a chain that a cell's border cuts becomes whole; one without such a bond stays where it is.
#include "prepare/make_whole.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/vector.h"

using namespace espdiff;  // NOLINT: a test

namespace {

/// Residues of N, CA and C along a zigzag of the length of bonds.
Molecule chain_of(int n_residues, const Vec3d& from) {
  Molecule molecule;
  int i = 0;
  for (int r = 0; r < n_residues; ++r) {
    molecule.residues.push_back({"ALA", "A", r + 1, ' '});
    for (const char* name : {"N", "CA", "C"}) {
      molecule.atoms.push_back({name, name[0] == 'N' ? "N" : "C", r, false});
      molecule.positions.push_back(from + Vec3d{1.2 * i, i % 2 == 0 ? 0.0 : 0.7, 0.1 * i});
      molecule.radii.push_back(1.7F);
      ++i;
    }
  }
  return molecule;
}

/// Every atom in the cell.
Molecule wrapped(Molecule molecule, const UnitCell& cell) {
  for (Vec3d& p : molecule.positions) {
    for (int axis = 0; axis < 3; ++axis) p[axis] -= cell.lengths[axis] * std::floor(p[axis] / cell.lengths[axis]);
  }
  return molecule;
}

const UnitCell kCell{{30, 32, 34}, {90, 90, 90}};

}  // namespace

TEST_CASE("make_whole: distances within the chain are those before it was wrapped, wherever the border lies") {
  for (const double x : {0.0, 5.0, 11.3, 23.0}) {
    const Molecule whole = chain_of(12, {x, 31.8, 33});
    Molecule molecule = wrapped(whole, kCell);
    const std::size_t n = make_whole(molecule, kCell);
    CAPTURE(x);
    CHECK(n > 0);
    for (std::size_t i = 1; i < whole.size(); ++i)
      CHECK(norm((molecule.positions[i] - molecule.positions[0]) - (whole.positions[i] - whole.positions[0])) < 1e-9);
    CHECK(made_whole_in_words(n).find("crossed the border of its periodic cell at ") == 0);
  }
}

TEST_CASE("make_whole: without a bond across the border nothing moves, not even what a crystal has gaps in") {
  Molecule molecule = chain_of(6, {2, 2, 2});
  // A loop is missing, and what follows lies near the other side of the cell.
  const Molecule beyond = chain_of(6, {2, 28, 2});
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    molecule.atoms.push_back(beyond.atoms[i]);
    molecule.atoms.back().residue += 6;
    molecule.positions.push_back(beyond.positions[i]);
    molecule.radii.push_back(1.7F);
  }
  for (const Residue& r : beyond.residues) molecule.residues.push_back({r.name, r.chain, r.number + 20, ' '});
  const std::vector<Vec3d> before = molecule.positions;
  CHECK(make_whole(molecule, kCell) == 0);
  CHECK(molecule.positions == before);
  CHECK(make_whole(molecule, {{30, 30, 30}, {10, 10, 170}}) == 0);  // no such cell
}
