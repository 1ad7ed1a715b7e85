// Selections in gemmi's syntax, against what they say in words.
#include "io/molecules/select_atoms.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "base/error.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

namespace {

/// Chain A: ALA 1, GLY 2, ATP 9 (HETATM), water; chain B: ALA 1, SER 1A.
const char* const kTwoChainPdb =
    "ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  0.00           N\n"
    "ATOM      2  CA  ALA A   1       1.500   0.000   0.000  1.00  0.00           C\n"
    "ATOM      3  C   ALA A   1       2.000   1.400   0.000  1.00  0.00           C\n"
    "ATOM      4  N   GLY A   2       3.300   1.500   0.000  1.00  0.00           N\n"
    "ATOM      5  CA  GLY A   2       4.000   2.800   0.000  1.00  0.00           C\n"
    "HETATM    6  PA  ATP A   9       9.000   2.800   0.000  1.00  0.00           P\n"
    "HETATM    7  O   HOH A 101      12.000   2.800   0.000  1.00  0.00           O\n"
    "ATOM      8  CA  ALA B   1       0.000   9.000   0.000  1.00  0.00           C\n"
    "ATOM      9  N   ALA B   1       1.000   9.000   0.000  1.00  0.00           N\n"
    "ATOM     10  CA  SER B   1A      3.000   9.000   0.000  1.00  0.00           C\n"
    "ATOM     11  N   SER B   1A      4.000   9.000   0.000  1.00  0.00           N\n";

Molecule made() {
  const ScratchFolder folder;
  Molecule molecule = read_structure(folder.write("made.pdb", kTwoChainPdb), {1, true, true});
  molecule.name = "made.pdb";
  return molecule;
}

std::ptrdiff_t n_selected(const std::string& selection) {
  const auto selected = select_atoms(made(), selection, "select");
  return std::count(selected.begin(), selected.end(), true);
}

}  // namespace

TEST_CASE("select_atoms: chains, numbers, insertion codes, names, elements, kinds, unions") {
#ifndef ESPDIFF_HAVE_GEMMI
  MESSAGE("SKIPPED: this build lacks gemmi");
  return;
#endif
  CHECK(n_selected("//A") == 7);
  CHECK(n_selected("//B") == 4);
  CHECK(n_selected("//A/1-2") == 5);
  CHECK(n_selected("//A/1") == 3);
  CHECK(n_selected("//A/2-") == 4);
  CHECK(n_selected("//B/1.A") == 2);
  CHECK(n_selected("(ATP)") == 1);
  CHECK(n_selected("(ATP,HOH)") == 2);
  CHECK(n_selected("(!ALA)") == 6);
  CHECK(n_selected("//*//CA") == 4);
  CHECK(n_selected("//*//[P]") == 1);
  CHECK(n_selected("//A;polymer") == 5);
  CHECK(n_selected("//A/2 //B/1.A") == 4);
  CHECK(n_selected("//Z") == 0);
}

TEST_CASE("select_atoms: lists of residues, and numbers below zero") {
#ifndef ESPDIFF_HAVE_GEMMI
  MESSAGE("SKIPPED: this build lacks gemmi");
  return;
#endif
  Molecule molecule = made();
  molecule.residues[1].number = -2;  // GLY
  molecule.residues[2].number = -1;  // ATP
  const auto count = [&](const std::string& selection) {
    const auto selected = select_atoms(molecule, selection, "select");
    return std::count(selected.begin(), selected.end(), true);
  };
  CHECK(count("//A/1,101") == 4);
  CHECK(count("//A/1,-1,101") == 5);
  CHECK(count("//A/-2") == 2);
  CHECK(count("//A/-2--1") == 3);
  CHECK(count("//A/-2-1/CA") == 2);
  CHECK(count("//A/-2,50-200(GLY,HOH)") == 3);
  CHECK(count("A/-1,1") == 4);
  CHECK(count("-2--1") == 3);
  CHECK(count("1,101") == 6);
  CHECK(count("//A/*--1") == 3);
  CHECK(count("//A/1-") == 4);
  CHECK(count("//B/1.*") == 4);
  CHECK(count("//B/1,1A") == 4);
  CHECK(count("//A/-2--1;polymer") == 2);
  CHECK(count("//A/*(GLY)") == 2);
}

TEST_CASE("select_atoms: what cannot be selected is refused in our words") {
#ifdef ESPDIFF_HAVE_GEMMI
  CHECK(message_of([] { n_selected("//A//["); }) ==
        "select: '//A//[' is not a selection such as //A, //A/10-20, (AP5,CL) or //A;polymer (gemmi's syntax: "
        "/model/chains/residues/atoms)");
  const std::string remedy =
      " is not a residue's number or a range; give such as 26, 10-20, -3--1 or 10.A, or several separated by commas "
      "without blanks: 26,27,30-40";
  CHECK(message_of([] { n_selected("//A/["); }) == "select: '[' in '//A/['" + remedy);
  CHECK(message_of([] { n_selected("//A/26,x7"); }) == "select: 'x7' in '//A/26,x7'" + remedy);
  CHECK(message_of([] { n_selected("//A/26, 27"); }) == "select: '' in '//A/26,'" + remedy);
  CHECK(message_of([] { n_selected("20-10"); }) == "select: '20-10' in '20-10'" + remedy);
  CHECK(message_of([] { n_selected("//A/99999999999/CA"); }) ==
        "select: '99999999999' in '//A/99999999999/CA'" + remedy);
  CHECK(message_of([] { n_selected("//A/(ALA)-20"); }) ==
        "select: '//A/(ALA)-20' has residue numbers behind names; give them before: 10-20(ALA)");
  CHECK(message_of([] { n_selected("/1/A"); }).find("which are not known here") != std::string::npos);
  CHECK(message_of([] { n_selected("//A//*:B"); }).find("alternate location") != std::string::npos);
  CHECK(message_of([] { n_selected("  "); }) == "select: an empty selection; name atoms, such as //A");
  CHECK(message_of([] { select_some_atoms(made(), "//C/5", "target-select"); }) ==
        "made.pdb: target-select '//C/5' selects no atom; the file has chain A (1-2, ATP, HOH), chain B (1-1)");
#endif
}

TEST_CASE("keep_atoms: residues without atoms go, the others keep their order") {
  const Molecule molecule = made();
  std::vector<bool> keep(molecule.size(), false);
  keep[3] = keep[9] = true;
  const Molecule kept = keep_atoms(molecule, keep);
  REQUIRE(kept.size() == 2);
  REQUIRE(kept.residues.size() == 2);
  CHECK(kept.residues[0].name == "GLY");
  CHECK(kept.residues[1].insertion_code == 'A');
  CHECK(kept.atoms[1].residue == 1);
  CHECK(kept.positions[1].x == 3);
  CHECK(kept.radii.size() == 2);
}
