// residue_names.cpp: equivalent spellings, and kinds of residues.
#include "align/residue_names.h"

#include <doctest/doctest.h>

#include "made_molecule.h"

using namespace espdiff;
using espdiff_test::MadeMolecule;

TEST_CASE("force fields' residue names map to their amino acid") {
  for (const char* name : {"HIS", "HSD", "HSE", "HSP", "HID", "HIE", "HIP", "hie", "NHIE"})
    CHECK(residue_letter(name) == 'H');
  for (const char* name : {"CYS", "CYX", "CYM", "CCYX"}) CHECK(residue_letter(name) == 'C');
  CHECK(residue_letter("ASH") == 'D');
  CHECK(residue_letter("GLH") == 'E');
  CHECK(residue_letter("LYN") == 'K');
  CHECK(residue_letter("MSE") == 'M');
  CHECK(residue_letter("NTE") == '?');
  CHECK(residue_letter("CTE") == '?');
  CHECK(residue_letter("DMS") == '?');
  CHECK(residue_letter("") == '?');
}

TEST_CASE("nucleotides have their own letters, so that A is not alanine") {
  for (const char* name : {"A", "DA", "RA", "ADE", "A5", "DA3", "RA5"}) CHECK(residue_letter(name) == 'a');
  CHECK(residue_letter("DT") == 't');
  CHECK(residue_letter("U") == 'u');
  CHECK_FALSE(same_residue_name("A", "ALA"));
  CHECK(same_residue_name("HSD", "HIE"));
  CHECK(same_residue_name("NTE", "NTE"));
  CHECK_FALSE(same_residue_name("NTE", "CTE"));
}

TEST_CASE("heavy atoms of the amino acids; other letters have any") {
  CHECK(is_heavy_atom_of('C', "SG"));
  CHECK(is_heavy_atom_of('C', "OXT"));
  CHECK(is_heavy_atom_of('W', "CH2"));
  CHECK_FALSE(is_heavy_atom_of('C', "P"));
  CHECK_FALSE(is_heavy_atom_of('G', "CB"));
  CHECK_FALSE(is_heavy_atom_of('L', "CD"));
  CHECK(is_heavy_atom_of('?', "P"));
  CHECK(is_heavy_atom_of('a', "P"));
  CHECK(n_heavy_atoms_of('G') == 4);
  CHECK(n_heavy_atoms_of('C') == 6);
  CHECK(n_heavy_atoms_of('W') == 14);
  CHECK(n_heavy_atoms_of('a') == 0);
}

TEST_CASE("old, CHARMM and current atom names are normalized to one spelling") {
  CHECK(normalized_atom_name("1HB") == "HB1");
  CHECK(normalized_atom_name("2HG1") == "HG12");
  CHECK(normalized_atom_name(" HN ") == "H");
  CHECK(normalized_atom_name("OT2") == "OXT");
  CHECK(normalized_atom_name("C5M", 't') == "C7");  // thymine's; elsewhere it is another atom
  CHECK(normalized_atom_name("C5M", 'u') == "C5M");
  CHECK(normalized_atom_name("O1P") == "OP1");
  CHECK(normalized_atom_name("C5*") == "C5'");
  CHECK(normalized_atom_name("1H5*") == "H5'");
  CHECK(normalized_atom_name("2H5*") == "H5''");
  CHECK(normalized_atom_name("H5\"") == "H5''");
  CHECK(normalized_atom_name("ca") == "CA");
  CHECK(normalized_atom_name("123") == "123");
  CHECK(normalized_atom_name("CD", 'I') == "CD1");
  CHECK(normalized_atom_name("HD2", 'I') == "HD12");
  CHECK(normalized_atom_name("CD", 'K') == "CD");
}

TEST_CASE("a residue's kind follows from its name, otherwise from its atoms") {
  MadeMolecule made;
  made.residue("A", 1, "ALA", {"CA"});
  made.residue("A", 2, "XAA", {"N", "CA", "C", "O"});
  made.residue("A", 3, "PSU", {"P", "C1'", "C3*", "C4'", "O3'"});
  made.residue("A", 4, "CA", {"CA"});
  made.residue("A", 5, "HOH", {"O"});
  made.residue("A", 6, "DMS", {"S", "O", "C1", "C2"});
  made.residue("A", 7, "SPCE", {"OW"});
  const auto kinds = residue_kinds(made.molecule, atoms_of_residues(made.molecule));
  const std::vector<ResidueKind> expected = {ResidueKind::kAminoAcid, ResidueKind::kAminoAcid, ResidueKind::kNucleotide,
                                             ResidueKind::kOther,     ResidueKind::kWater,     ResidueKind::kOther,
                                             ResidueKind::kWater};
  CHECK(kinds == expected);
}
