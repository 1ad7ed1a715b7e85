// Coordinates that cannot be right are refused where the whole file has them, and named where a residue has them.
#include <doctest/doctest.h>

#include <cmath>

#include "align/pair_residues.h"
#include "compare/made_peptide.h"
#include "input_checks/geometry_warnings.h"

using namespace espdiff;
using espdiff_test::made_peptide;

namespace {

std::vector<std::pair<std::string, bool>> geometry_of(const Molecule& molecule) {
  std::vector<Warning> warnings;
  check_geometry("source", ResidueView(molecule), warnings);
  std::vector<std::pair<std::string, bool>> texts;
  for (const Warning& warning : warnings) texts.emplace_back(warning.text.plain(), warning.refuses);
  return texts;
}

void refuses_geometry(const Molecule& molecule, const std::string& text) {
  const auto texts = geometry_of(molecule);
  REQUIRE(texts.size() == 1);
  CHECK(texts[0].first == text);
  CHECK(texts[0].second);
}

template <typename Change>
Molecule changed(Change change) {
  Molecule molecule = made_peptide(12);
  for (Vec3d& p : molecule.positions) p = change(p);
  return molecule;
}

/// Without the atoms that `drop` names.
template <typename Drop>
Molecule without(Drop drop) {
  const Molecule molecule = made_peptide(12);
  Molecule rest;
  rest.residues = molecule.residues;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (drop(molecule.atoms[i].name)) continue;
    rest.atoms.push_back(molecule.atoms[i]);
    rest.positions.push_back(molecule.positions[i]);
  }
  return rest;
}

}  // namespace

TEST_CASE("check_geometry: a right peptide has nothing") { CHECK(geometry_of(made_peptide(12)).empty()); }

TEST_CASE("check_geometry: nm, scaled and rounded coordinates are refused") {
  refuses_geometry(changed([](const Vec3d& p) { return 0.1 * p; }),
                   "the coordinates of the source are in nm: the median bond of its backbone has 0.1 of its usual "
                   "length; multiply them by 10");
  refuses_geometry(changed([](const Vec3d& p) { return 1.1 * p; }),
                   "the coordinates of the source are scaled: the median bond of its backbone has 1.1 of its usual "
                   "length");
  const auto rounded = [](const Vec3d& p) { return Vec3d{std::round(p.x), std::round(p.y), std::round(p.z)}; };
  refuses_geometry(changed(rounded), "the coordinates of the source are rounded to 1 A, which is coarser than bonds");
  const auto texts = geometry_of(changed([&](const Vec3d& p) { return rounded(p) + Vec3d{0.3, 0.2, 0.1}; }));
  REQUIRE(!texts.empty());
  CHECK(texts[0].second);
}

TEST_CASE("check_geometry: molecules without side chains are refused") {
  const std::string text =
      "12 of 12 residues of the source have no side chains: its surface is not that of the molecule; give all atoms";
  refuses_geometry(
      without([](const std::string& name) { return name != "N" && name != "CA" && name != "C" && name != "O"; }), text);
  refuses_geometry(without([](const std::string& name) { return name != "CA"; }), text);
}

TEST_CASE("check_geometry: a chain on top of another is refused, with their names") {
  Molecule molecule = made_peptide(12), copy = made_peptide(12, "B");
  for (Atom& atom : copy.atoms) atom.residue += 12;
  molecule.residues.insert(molecule.residues.end(), copy.residues.begin(), copy.residues.end());
  molecule.atoms.insert(molecule.atoms.end(), copy.atoms.begin(), copy.atoms.end());
  for (const Vec3d& p : copy.positions) molecule.positions.push_back(p + Vec3d{0.5, 0.3, 0.2});
  const auto texts = geometry_of(molecule);
  REQUIRE(texts.size() == 1);
  CHECK(texts[0].second);
  CHECK(
      texts[0].first.find("24 residues of the source lie on the place of another: SER 1 of chain A (on SER 1 of chain "
                          "B)") == 0);
  CHECK(texts[0].first.find("; chain B lies on chain A, as where one file holds two states or a chain twice: give one "
                            "of them (select)") != std::string::npos);
}

TEST_CASE("check_geometry: one stretched bond and one clash are named and not refused") {
  Molecule molecule = made_peptide(12);
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (molecule.atoms[i].residue == 6 && molecule.atoms[i].name == "OG")
      molecule.positions[i] = molecule.positions[i - 1];
    if (molecule.atoms[i].residue == 1 && molecule.atoms[i].name == "NZ") molecule.positions[i].z += 3;
  }
  const auto texts = geometry_of(molecule);
  REQUIRE(texts.size() == 2);
  CHECK(texts[0].first ==
        "1 residue of the source has a gap that no bond spans: LYS 2 of chain A (NZ 4.37 A from the rest)");
  CHECK_FALSE(texts[0].second);
  CHECK(texts[1].first ==
        "1 residue of the source has atoms nearer to each other than any bond: SER 7 of chain A (CB and OG 0 A apart)");
}
