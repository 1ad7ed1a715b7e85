// chemical_formula.cpp: formulas as PDB's FORMUL records and mmCIF write them.
#include "base/chemical_formula.h"

#include <doctest/doctest.h>

using namespace espdiff;  // NOLINT: a test

TEST_CASE("parse_formula: elements, numbers, copies and charges") {
  const auto plain = parse_formula("C33 H41 N5 O6 S2");
  REQUIRE(plain);
  CHECK(plain->atoms == std::map<std::string, int>{{"C", 33}, {"H", 41}, {"N", 5}, {"O", 6}, {"S", 2}});
  CHECK(plain->charge == 0);
  const auto sulfate = parse_formula(" 2(O4 S 2-) ");
  REQUIRE(sulfate);
  CHECK(sulfate->atoms.at("O") == 4);
  CHECK(sulfate->charge == -2);
  CHECK(parse_formula("*6(H2 O)")->atoms.at("H") == 2);
  CHECK(parse_formula("ZN 2+")->atoms.at("Zn") == 1);
  CHECK(parse_formula("ZN 2+")->charge == 2);
  CHECK(parse_formula("C4 H12 N -1")->charge == -1);
  for (const char* wrong : {"", "(", "C33 H41 ?", "C3x4", "2", "C1 3*"}) CHECK_FALSE(parse_formula(wrong));
}

TEST_CASE("formulas_in_pdb: records before the atoms, with continuation lines") {
  const auto formulas = formulas_in_pdb(
      "HET    KNI  B 900      87\n"
      "FORMUL   3  KNI    C33 H41 N5\n"
      "FORMUL   3  KNI  2 O6 S2\n"
      "FORMUL   4   ZN    2(ZN 2+)\n"
      "FORMUL   5  HOH   *6(H2 O)\n"
      "ATOM      1  N   PRO A   1      -1.000   0.000   0.000  1.00  0.00           N\n"
      "FORMUL   6  XYZ    C1 H4\n");
  CHECK(formulas.size() == 3);
  CHECK(formulas.at("KNI").atoms.at("S") == 2);
  CHECK(formulas.at("ZN").charge == 2);
  CHECK(formulas.count("XYZ") == 0);
}
