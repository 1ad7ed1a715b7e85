// chain_links.cpp: chains found by bonds and numbers, in files of any order.
#include "align/chain_links.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "align/geometry/chain_motions.h"
#include "base/molecule/screw.h"
#include "base/types.h"

using namespace espdiff;

namespace {

/// Glycines along x, 3.8 A apart, each bonded to the next.
struct Strand {
  Molecule molecule;

  void add(const std::string& chain, int number, const Vec3d& at, char code = ' ') {
    molecule.residues.push_back({"GLY", chain, number, code});
    const auto residue = static_cast<std::int32_t>(molecule.residues.size() - 1);
    for (const auto& [name, x] : {std::pair("CA", 0.0), std::pair("C", 1.4), std::pair("N", -1.1)}) {
      molecule.atoms.push_back({name, std::string(1, name[0]), residue, false});
      molecule.positions.push_back(at + Vec3d{x, 0, 0});
      molecule.radii.push_back(1.7F);
    }
  }

  /// The residue numbers of each chain, "1 2 3;10 11;".
  std::string chains() const {
    std::string text;
    for (const auto& chain : chain_links(ResidueView(molecule)).chains) {
      for (const std::size_t r : chain) {
        text += (r == chain.front() ? "" : " ") + std::to_string(molecule.residues[r].number);
        if (molecule.residues[r].insertion_code != ' ') text += molecule.residues[r].insertion_code;
      }
      text += ";";
    }
    return text;
  }
};

}  // namespace

TEST_SUITE_BEGIN("chain_links");

TEST_CASE("bonds link residues in any order and under any number") {
  Strand strand;
  for (const int k : {2, 0, 3, 1}) strand.add("A", k == 3 ? -7 : 10 + k, {3.8 * k, 0, 0});
  CHECK(strand.chains() == "10 11 12 -7;");
}

TEST_CASE("what has no bond is linked by number and insertion code, across a gap too") {
  Strand strand;
  strand.add("A", 12, {40, 0, 0});
  strand.add("A", 10, {0, 0, 0});
  strand.add("A", 10, {20, 0, 0}, 'A');
  strand.add("B", 11, {30, 0, 0});
  CHECK(strand.chains() == "10 10A 12;11;");
}

TEST_CASE("two chains of one name and the same numbers stay apart, and of two ways the nearer is taken") {
  Strand strand;
  for (const int number : {1, 2, 5, 6}) {
    for (const double y : {0.0, 15.0}) strand.add("", number, {3.8 * number + (number > 4 ? 4 : 0), y, 0});
  }
  const ChainLinks links = chain_links(ResidueView(strand.molecule));
  REQUIRE(links.chains.size() == 2);
  for (const auto& chain : links.chains) {
    REQUIRE(chain.size() == 4);
    for (const std::size_t r : chain)
      CHECK(strand.molecule.positions[3 * r].y == strand.molecule.positions[3 * chain.front()].y);
  }
}

TEST_CASE("a ring has each residue once") {
  Strand strand;
  for (int k = 0; k < 3; ++k) strand.add("A", k + 1, {3.8 * k, 0, 0});
  strand.molecule.positions[2] = {3.8 * 2 + 2.4, 0.5, 0};  // N of the first at C of the last
  CHECK(strand.chains() == "1 2 3;");
}

TEST_CASE("a chain's motion against the two that stay is a rotation and a shift") {
  Molecule source;
  AtomPairing pairing;
  for (const std::string chain : {"A", "B", "C"}) {
    for (int k = 0; k < 25; ++k) {
      source.residues.push_back({"GLY", chain, k, ' '});
      source.atoms.push_back({"CA", "C", static_cast<std::int32_t>(source.residues.size() - 1), false});
      source.positions.push_back({chain == "A"   ? 0.0
                                  : chain == "B" ? 30.0
                                                 : 60.0,
                                  3.0 * std::cos(k), 3.0 * std::sin(k) + 0.7 * k});
    }
  }
  Molecule target = source;
  for (std::size_t i = 0; i < source.size(); ++i) pairing.pairs.emplace_back(i, i);
  Screw screw;
  screw.axis = {0, 0, 1};
  screw.angle = 20 * kPi / 180;
  Vec3d centre{};
  for (std::size_t i = 25; i < 50; ++i) centre += (1.0 / 25) * source.positions[i];
  for (std::size_t i = 25; i < 50; ++i)
    target.positions[i] = centre + screw.apply(source.positions[i] - centre, 1) + Vec3d{0, 0, 1.5};
  const std::vector<ChainMotion> motions = chain_motions(source, target, pairing);
  REQUIRE(motions.size() == 3);
  CHECK(motions[0].rmsd_A < 1e-9);
  CHECK(motions[2].rotation_degrees < 1e-6);
  CHECK(motions[1].chain == "B");
  CHECK(motions[1].rotation_degrees == doctest::Approx(20));
  CHECK(motions[1].shift_A == doctest::Approx(1.5));
  CHECK(motions[1].own_rmsd_A < 1e-9);
  CHECK(in_words({motions[1]}) == "B by 20.0 degrees and 1.5 A");
  for (Residue& residue : source.residues) residue.chain = "A";
  CHECK(chain_motions(source, target, pairing).empty());
}

TEST_SUITE_END();
