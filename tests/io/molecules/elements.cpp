// elements.cpp: radii by element and elements by atom name.
#include "io/molecules/elements.h"
#include "base/molecule/water.h"
#include "io/molecules/molecule_builder.h"
#include "support/test_data.h"

using namespace espdiff;

TEST_CASE("elements: Bondi's radii, Alvarez' for the others, carbon's for unknown ones") {
  CHECK(element_radius("H") == 1.20F);
  CHECK(element_radius("D") == 1.20F);
  CHECK(element_radius("C") == 1.70F);
  CHECK(element_radius("N") == 1.55F);
  CHECK(element_radius("O") == 1.52F);
  CHECK(element_radius("S") == 1.80F);
  CHECK(element_radius("P") == 1.80F);
  CHECK(element_radius("Zn") == 1.39F);
  CHECK(element_radius("ZN") == 1.39F);
  CHECK(element_radius("zn") == 1.39F);
  CHECK(element_radius("Ca") == 2.62F);
  CHECK(element_radius("Fe") == 2.44F);
  CHECK(element_radius("") == 1.7F);
  CHECK(element_radius("Xx") == 1.7F);
}

TEST_CASE("elements: names in standard residues are read by their first letter") {
  CHECK(element_from_atom_name("CA", "ALA") == "C");
  CHECK(element_from_atom_name("CD", "GLN") == "C");
  CHECK(element_from_atom_name("NE2", "HSD") == "N");
  CHECK(element_from_atom_name("HG", "SER") == "H");
  CHECK(element_from_atom_name("1HB2", "LEU") == "H");
  CHECK(element_from_atom_name("OXT", "GLU") == "O");
  CHECK(element_from_atom_name("SD", "MET") == "S");
  CHECK(element_from_atom_name("O5'", "DG") == "O");
  CHECK(element_from_atom_name("H2''", "C") == "H");
  CHECK(element_from_atom_name("SE", "MSE") == "Se");
}

TEST_CASE("elements: ions carry the residue's name") {
  CHECK(element_from_atom_name("CA", "CA") == "Ca");
  CHECK(element_from_atom_name("ZN", "ZN2") == "Zn");
  CHECK(element_from_atom_name("NA+", "NA+") == "Na");
  CHECK(element_from_atom_name("Cl-", "Cl-") == "Cl");
  CHECK(element_from_atom_name("K", "K") == "K");
  CHECK(element_from_atom_name("SOD", "SOD") == "Na");
  CHECK(element_from_atom_name("CLA", "CLA") == "Cl");
  CHECK(element_from_atom_name("CAL", "CAL") == "Ca");
  CHECK(element_from_atom_name("HG", "HG") == "Hg");
}

TEST_CASE("elements: ligands and cofactors") {
  CHECK(element_from_atom_name("FE", "HEM") == "Fe");
  CHECK(element_from_atom_name("NA", "HEM") == "N");
  CHECK(element_from_atom_name("CL1", "LIG") == "Cl");
  CHECK(element_from_atom_name("BR", "LIG") == "Br");
  CHECK(element_from_atom_name("CAB", "LIG") == "C");
  CHECK(element_from_atom_name("PA", "ATP") == "P");
  CHECK(element_from_atom_name("X", "CEN") == "");
  CHECK(element_from_atom_name("", "LIG") == "");
  CHECK(element_from_atom_name("12", "LIG") == "");
}

TEST_CASE("elements: water by its residue names") {
  for (const char* name : {"HOH", "WAT", "TIP3", "SOL", "DOD", "TIP2", "TP5", "SPCE", "OH2"})
    CHECK_MESSAGE(is_water_name(name), name);
  for (const char* name : {"", "ALA", "HO", "SO4"}) CHECK_FALSE_MESSAGE(is_water_name(name), name);
}
