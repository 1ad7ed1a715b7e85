// mol2_structures.cpp: MOL2 files as structures: residues, chains, elements, charges, several molecules.
#include "base/error.h"
#include "io/structures/structure_file.h"
#include "io/structures/structure_text.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

std::string mol2(const std::string& atoms, const std::string& charge_type = "USER_CHARGES") {
  return "@<TRIPOS>MOLECULE\nmade\n 0 0 0 0 0\nPROTEIN\n" + charge_type + "\n\n@<TRIPOS>ATOM\n" + atoms;
}

const std::string kDipeptide =
    "1 N 0 0 0 N.am 1 ALA12 -0.5\n2 CA 1.5 0 0 C.3 1 ALA12 0.25\n3 CA 5 0 0 Ca 2 CA2 2.0\n"
    "@<TRIPOS>SUBSTRUCTURE\n1 ALA12 1 RESIDUE 1 B ALA 1\n2 CA2 3 **** 0 **** ****\n";

}  // namespace

TEST_CASE("mol2: names, numbers and chains of residues, elements by type, charges, radii by element") {
  const Molecule m = structure_of("a.mol2", mol2(kDipeptide));
  REQUIRE(m.size() == 3);
  REQUIRE(m.residues.size() == 2);
  CHECK(m.residues[0].name == "ALA");
  CHECK(m.residues[0].number == 12);
  CHECK(m.residues[0].chain == "B");
  CHECK(m.residues[1].name == "CA");
  CHECK(m.residues[1].number == 2);
  CHECK(m.residues[1].chain.empty());
  CHECK(m.atoms[1].element == "C");
  CHECK(m.atoms[2].element == "Ca");
  CHECK(m.charges == std::vector<float>{-0.5F, 0.25F, 2.0F});
  CHECK(m.radii_origin == ValueOrigin::kElement);
  CHECK(m.radii[0] == 1.55F);
}

TEST_CASE("mol2: names of residues with digits of their own keep them") {
  const auto residue = [](const std::string& words) {
    const Molecule m = structure_of("a.mol2", mol2("1 X1 0 0 0 C.3 " + words + " 0.1\n"));
    return m.residues[0].name + " " + std::to_string(m.residues[0].number);
  };
  CHECK(residue("7 ALA7") == "ALA 7");
  CHECK(residue("1 GLY103") == "GLY 103");
  CHECK(residue("1 DA5") == "DA5 1");  // a nucleotide's 5' end
  CHECK(residue("5 DA5") == "DA 5");
  CHECK(residue("1 DA12") == "DA 12");
  CHECK(residue("1 L8A") == "L8A 1");
  CHECK(residue("3 STI") == "STI 3");
  CHECK(residue("2 <0>") == "<0> 2");
  CHECK(residue("2 ****") == "LIG 2");
  CHECK(residue("4 99") == "99 4");
  CHECK(residue("1 LIG99999999999999999999") == "LIG99999999999999999999 1");
}

TEST_CASE("mol2: types of force fields are no elements, and repeated names get numbers") {
  const Molecule gaff = structure_of("a.mol2", mol2("1 CL1 0 0 0 cl 1 LIG -0.1\n2 C2 3 0 0 ca 1 LIG 0.1\n"));
  CHECK(gaff.atoms[0].element == "Cl");
  CHECK(gaff.atoms[1].element == "C");
  const Molecule m = structure_of("b.mol2",
                                  mol2("1 C 0 0 0 C.3 1 LIG 0.1\n2 C 3 0 0 C.3 1 LIG 0.2\n3 O 6 0 0 O.3 1 LIG -0.3\n"
                                       "4 O 9 0 0 O.3 2 WAT -0.8\n"),
                                  {1, true, true, {}});
  REQUIRE(m.size() == 4);
  CHECK(m.atoms[0].name == "C1");
  CHECK(m.atoms[1].name == "C2");
  CHECK(m.atoms[2].name == "O3");
  CHECK(m.atoms[3].name == "O");
  CHECK(structure_of("b.mol2", mol2("1 C 0 0 0 C.3 1 LIG 0.1\n2 O 9 0 0 O.3 2 WAT -0.8\n")).charges ==
        std::vector<float>{0.1F});
}

TEST_CASE("mol2: no charges where the file says so, an atom lacks one, or all are zero") {
  const std::string two = "1 C1 0 0 0 C.3 1 LIG 0.1\n2 C2 3 0 0 C.3 1 LIG -0.1\n";
  CHECK(structure_of("a.mol2", mol2(two)).charges.size() == 2);
  CHECK(structure_of("a.mol2", mol2(two, "NO_CHARGES")).charges.empty());
  CHECK(structure_of("a.mol2", mol2(two + "3 C3 6 0 0 C.3 1 LIG\n")).charges.empty());
  CHECK(structure_of("a.mol2", mol2(two + "3 C3 6 0 0 C.3 1 LIG ****\n")).charges.empty());
  CHECK(structure_of("a.mol2", mol2("1 C1 0 0 0 C.3 1 LIG 0.0\n")).charges.empty());
  CHECK(structure_error("a.mol2", mol2("1 C1 0 0 0 C.3 1 LIG 1e9\n")) ==
        "a.mol2:8: charge of atom 'C1' is 1e+09; elementary charges between -1e6 and 1e6 were expected");
}

TEST_CASE("mol2: molecules are models, and the line of a residue is known") {
  const ScratchFolder folder;
  const StructureFile file(
      folder.write("a.mol2", mol2("1 C1 0 0 0 C.3 1 LIG 0.1\n") +
                                 mol2("1 N1 0 0 0 N.3 1 ONE1 0.3\n2 O 3 0 0 O.3 2 TWO2 -0.1\n", "NO_CHARGES")));
  CHECK(file.n_models() == 2);
  CHECK(file.read({1, true, false, {}}).charges.size() == 1);
  const Molecule second = file.read({2, true, false, {}});
  CHECK(second.charges.empty());
  CHECK(second.residues[1].name == "TWO");
  CHECK(file.line_of(2, second.residues[1]) == 17);
  CHECK(message_of([&] {
          file.read({3, true, false, {}});
        }).find("there is no model 3; the file has 2") != std::string::npos);
  CHECK(message_of([&] {
          file.read({1, true, false, "1"});
        }).find("is a MOL2 file, which describes no assemblies; leave assembly out") != std::string::npos);
  CHECK(structure_error("a.sdf", "LIG\n made\n\n  1  0  0  0  0  0  0  0  0  0999 V2000\n    0.0 0.0 0.0 C\n") ==
        "a.sdf: this looks like an SDF structure, which is not read as a structure; `obabel LIGAND.sdf -O LIGAND.mol2` "
        "writes it with charges; give that");
  CHECK(structure_error("a.mol2", "@<TRIPOS>MOLECULE\nnothing\n") ==
        "a.mol2: has no @<TRIPOS>ATOM section; give a MOL2 file with atoms");
}
