// Net charges by name, for all spellings of protonation states.
#include "align/residue_charges.h"

#include <doctest/doctest.h>

#include "align/residue_names.h"

using namespace espdiff;

TEST_CASE("possible_charges: names of all conventions") {
  using Charges = std::vector<int>;
  for (const char* const name : {"ASP", "GLU", "CYS", "TYR"}) CHECK(possible_charges(name) == Charges{-1, 0});
  for (const char* const name : {"LYS", "ARG", "HIS"}) CHECK(possible_charges(name) == Charges{0, 1});
  for (const char* const name :
       {"ASH", "AS0", "ASPP", "GLH", "GL0", "GLUP", "LYN", "LY0", "LSN", "AR0", "HID", "HSE", "CYX", "ALA"})
    CHECK(possible_charges(name) == Charges{0});
  for (const char* const name : {"HIP", "HSP", "HI+", "HISH", "LYSH", "AR+", "LY+"})
    CHECK(possible_charges(name) == Charges{1});
  for (const char* const name : {"CYM", "CY-", "TYM", "TY-", "AS-", "GL-", "DA", "RU"})
    CHECK(possible_charges(name) == Charges{-1});
  CHECK(possible_charges("NHIP") == Charges{1});
  CHECK(possible_charges("CASP") == Charges{-1, 0});
  CHECK(possible_charges("LLP").empty());
  CHECK(possible_charges("HEM").empty());
}

TEST_CASE("residue_letter: PARSE's names of protonation states are those of their residues") {
  CHECK(same_residue_name("GL0", "GLU"));
  CHECK(same_residue_name("AR+", "ARG"));
  CHECK(same_residue_name("AS0", "ASP"));
  CHECK(same_residue_name("LY0", "LYS"));
  CHECK(same_residue_name("TY-", "TYR"));
  CHECK(same_residue_name("HI+", "HIS"));
  CHECK(same_residue_name("CSS", "CYX"));
}

TEST_CASE("charge_of_group: ions and common groups") {
  CHECK(charge_of_group("ZN", 1) == 2);
  CHECK(charge_of_group("CL", 1) == -1);
  CHECK(charge_of_group("SO4", 5) == -2);
  CHECK(charge_of_group("HEM", 43) == -2);
  CHECK(charge_of_group("CYN", 2) == -1);
  CHECK_FALSE(charge_of_group("XYZ", 3).has_value());
  CHECK(charge_of_group("CO", 1) == 2);
  CHECK_FALSE(charge_of_group("CO", 2).has_value());  // carbon monoxide
  CHECK(is_ion_name("NA"));
  CHECK_FALSE(is_ion_name("SO4"));
}
