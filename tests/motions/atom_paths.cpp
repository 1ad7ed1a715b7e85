// atom_paths.cpp: where unpaired atoms grow and shrink, and how that scales.
#include "motions/atom_paths.h"

#include <ctime>

#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::Atom;
using espdiff::AtomPairing;
using espdiff::Molecule;
using espdiff::MovingAtom;
using espdiff::Residue;
using espdiff::Vec3d;

namespace {

/// A row of `n` residues of one atom each, and as many that only this molecule has, beside them and far away.
Molecule row(std::size_t n, double beside) {
  Molecule molecule;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const double at = 3.0 * static_cast<double>(i % n);
    molecule.positions.push_back({at, i < n ? 0 : beside, i % 7 == 0 ? 60.0 : 0.0});
    molecule.radii.push_back(1.5F);
    Atom atom;
    atom.name = "C";
    atom.element = "C";
    atom.residue = static_cast<std::int32_t>(i);
    molecule.atoms.push_back(atom);
    Residue residue;
    residue.name = "LIP";
    residue.number = static_cast<std::int32_t>(i);
    molecule.residues.push_back(residue);
  }
  return molecule;
}

AtomPairing first_half(std::size_t n) {
  AtomPairing pairing;
  for (std::size_t i = 0; i < n; ++i) pairing.pairs.emplace_back(i, i);
  return pairing;
}

/// Processor time in s, which other programs do not add to.
double seconds_for(std::size_t n) {
  const Molecule source = row(n, 5), target = row(n, -5);
  const std::clock_t begun = std::clock();
  CHECK(atom_paths(source, target, first_half(n), {}, {}, {}, 1.0).size() == 3 * n);
  return static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
}

}  // namespace

TEST_SUITE_BEGIN("compare");

TEST_CASE("an unpaired atom shrinks into the nearest paired one, the first of several") {
  const std::size_t n = 60;
  const Molecule source = row(n, 5), target = row(n, -5);
  const std::vector<MovingAtom> paths = atom_paths(source, target, first_half(n), {}, {}, {}, 1.0);
  REQUIRE(paths.size() == 3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const MovingAtom& fading = paths[n + i];
    CHECK(fading.at_start);
    CHECK_FALSE(fading.at_end);
    std::size_t nearest = 0;
    for (std::size_t j = 1; j < n; ++j) {
      const Vec3d d = source.positions[j] - source.positions[n + i],
                  least = source.positions[nearest] - source.positions[n + i];
      if (dot(d, d) < dot(least, least)) nearest = j;
    }
    const Vec3d arm = source.positions[n + i] - source.positions[nearest];
    // Beyond 8 A it vanishes in place.
    CHECK(norm(fading.end - (norm(arm) > 8 ? target.positions[nearest] + arm : target.positions[nearest])) < 1e-9);
  }
}

TEST_CASE("four times the atoms take about four times as long, not sixteen") {
  seconds_for(1000);
  CHECK(seconds_for(40000) < 8 * seconds_for(10000) + 0.1);
}

TEST_SUITE_END();
