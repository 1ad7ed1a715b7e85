// Charges that cannot be right are refused where the whole file has them, and named where a residue has them.
#include <doctest/doctest.h>

#include <algorithm>

#include "align/pair_atoms.h"
#include "align/pair_residues.h"
#include "compare/made_peptide.h"
#include "input_checks/charge_warnings.h"

using namespace espdiff;
using espdiff_test::add_ion;
using espdiff_test::made_peptide;

namespace {

using Texts = std::vector<std::pair<std::string, bool>>;

Texts texts_of(const std::vector<Warning>& warnings) {
  Texts texts;
  for (const Warning& warning : warnings) texts.emplace_back(warning.text.plain(), warning.refuses);
  return texts;
}

Texts charges_of(const Molecule& molecule) {
  std::vector<Warning> warnings;
  check_charges("target", ResidueView(molecule), warnings);
  return texts_of(warnings);
}

Texts paired_charges_of(const Molecule& a, const Molecule& b) {
  std::vector<Warning> warnings;
  check_paired_charges(ResidueView(a), ResidueView(b), pair_atoms(a, b), warnings);
  return texts_of(warnings);
}

void refuses(const Molecule& molecule, const std::string& text) {
  const Texts texts = charges_of(molecule);
  REQUIRE(texts.size() == 1);
  CHECK(texts[0].second);
  CHECK(texts[0].first == text);
}

Molecule scaled(float factor) {
  Molecule molecule = made_peptide(12);
  for (float& q : molecule.charges) q *= factor;
  return molecule;
}

float& charge_of(Molecule& molecule, int residue, const std::string& name) {
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (molecule.atoms[i].residue == residue && molecule.atoms[i].name == name) return molecule.charges[i];
  }
  FAIL("no such atom");
  return molecule.charges[0];
}

}  // namespace

TEST_CASE("check_charges: a right peptide, and one without charges, have nothing") {
  CHECK(charges_of(made_peptide(12)).empty());
  Molecule bare = made_peptide(12);
  bare.charges.clear();
  CHECK(charges_of(bare).empty());
}

TEST_CASE("check_charges: another unit, scale or sign of all charges is refused") {
  const std::string range = ", and -0.3 to -0.8 e in every force field";
  refuses(scaled(18.2223F),
          "the charges of the target are in Amber's internal unit, of which 18.2223 are 1 e: the median charge of its "
          "backbone oxygens is -10.02 e" +
              range + "; divide them by 18.2223");
  refuses(scaled(0.1F),
          "the charges of the target are scaled or in another unit: the median charge of its backbone oxygens is "
          "-0.055 e" +
              range);
  refuses(scaled(-1),
          "all charges of the target have the wrong sign: the median charge of its backbone oxygens is 0.55 e" + range);
}

TEST_CASE("check_charges: charges at other atoms are refused, with their way back") {
  Molecule shifted = made_peptide(12);
  std::rotate(shifted.charges.begin(), shifted.charges.begin() + 1, shifted.charges.end());
  const Texts texts = charges_of(shifted);
  REQUIRE(texts.size() == 1);
  CHECK(texts[0].second);
  CHECK(texts[0].first.find("; they fit the atoms 1 after them in the file") != std::string::npos);
  // Names and atoms of the next residue: the signs of the backbone stay right.
  Molecule renamed = made_peptide(12);
  for (std::size_t r = 0; r < renamed.residues.size(); ++r) {
    static const char* const names[] = {"LYS", "ASP", "SER"};
    renamed.residues[r].name = names[r % 3];
  }
  const Texts of_residues = charges_of(renamed);
  REQUIRE(of_residues.size() == 1);
  CHECK(of_residues[0].second);
  CHECK(of_residues[0].first ==
        "11 residues of the target have net charges that name and hydrogens exclude: LYS 1 of chain A (0 e, not 1 or "
        "2), ASP 2 of chain A (1 e, not -1), SER 3 of chain A (-1 e, not 0), ...");
}

TEST_CASE("check_charges: hydrogens that were deleted with their charges are refused") {
  Molecule molecule = made_peptide(12), bare;
  bare.residues = molecule.residues;
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (molecule.atoms[i].element == "H") continue;
    bare.atoms.push_back(molecule.atoms[i]);
    bare.positions.push_back(molecule.positions[i]);
    bare.radii.push_back(molecule.radii[i]);
    bare.charges.push_back(molecule.charges[i]);
  }
  refuses(bare,
          "the charges of 12 residues of the target do not add up to a whole number: SER 1 of chain A (-0.4 e), LYS 2 "
          "of chain A (0.6 e), ASP 3 of chain A (-1.4 e), ...; it has no hydrogens, whose charges are missing as well");
}

TEST_CASE("check_charges: one residue or ion is named and not refused") {
  Molecule turned = made_peptide(12);
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (turned.atoms[i].residue == 3) turned.charges[i] *= -1;
  }
  CHECK(charges_of(turned) ==
        Texts{{"the backbone of 1 residue of the target has charges of the wrong sign: SER 4 of chain A (O 0.55 e)",
               false}});
  Molecule fractional = made_peptide(12);
  charge_of(fractional, 4, "NZ") = 0.7F;
  CHECK(charges_of(fractional) ==
        Texts{{"the charges of 1 residue of the target do not add up to a whole number: LYS 5 of chain A (0.7 e)",
               false}});
  Molecule ion = made_peptide(12);
  add_ion(ion, "ZN", -2);
  CHECK(charges_of(ion) ==
        Texts{{"1 ion of the target has a charge of the wrong sign or size: ZN 900 of chain A (-2 e, usually 2)",
               false}});
}

TEST_CASE("check_paired_charges: two force fields, and residues that differ by a charge alone") {
  const Molecule a = made_peptide(12);
  CHECK(paired_charges_of(a, a).empty());
  Molecule other = a;
  for (int r = 0; r < 12; ++r) {
    charge_of(other, r, "C") += 0.05F;
    charge_of(other, r, "O") -= 0.05F;
    charge_of(other, r, "N") -= 0.07F;
    charge_of(other, r, "H") += 0.07F;
  }
  const Texts fields = paired_charges_of(a, other);
  REQUIRE(fields.size() == 1);
  CHECK(fields[0].second);
  CHECK(fields[0].first ==
        "the charges are of two force fields: in 12 of 12 unchanged residues they differ, by 0.028 e an atom on "
        "average, which makes a difference by itself; take the charges of one origin");
  Molecule neutral = a;
  charge_of(neutral, 4, "NZ") = 0;
  CHECK(paired_charges_of(a, neutral) == Texts{{"1 residue of one name and the same hydrogens differs in net charge: "
                                                "LYS 5 of chain A (1 e, 0 e in the target)",
                                                false}});
}
