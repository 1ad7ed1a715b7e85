// Biological assemblies of PDB and mmCIF files; PDB files of old programs.
#include <doctest/doctest.h>

#include "base/error.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::real_input;
using espdiff_test::ScratchFolder;

namespace {

/// A dimer: the identity, and a rotation by 180 degrees about z with a shift along it.
const char* const kDimerPdb =
    "REMARK 350 BIOMOLECULE: 1\n"
    "REMARK 350 AUTHOR DETERMINED BIOLOGICAL UNIT: DIMERIC\n"
    "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
    "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n"
    "REMARK 350   BIOMT1   2 -1.000000  0.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT2   2  0.000000 -1.000000  0.000000        0.00000\n"
    "REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        5.00000\n"
    "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\n"
    "ATOM      2  CA  ALA A   1       2.500   2.000   3.000  1.00  0.00           C\n"
    "ATOM      3  CA  ALA B   1      20.000   2.000   3.000  1.00  0.00           C\n"
    "HETATM    4 ZN    ZN A 100       4.000   4.000   3.000  1.00  0.00          ZN\n";

const char* const kCif =
    "data_x\n_pdbx_struct_assembly.id 1\n_pdbx_struct_assembly.details author_defined_assembly\n"
    "_pdbx_struct_assembly.method_details ?\n_pdbx_struct_assembly.oligomeric_details dimeric\n"
    "_pdbx_struct_assembly.oligomeric_count 2\n#\n"
    "_pdbx_struct_assembly_gen.assembly_id 1\n_pdbx_struct_assembly_gen.oper_expression 1,2\n"
    "_pdbx_struct_assembly_gen.asym_id_list A\n#\nloop_\n_pdbx_struct_oper_list.id\n_pdbx_struct_oper_list.type\n"
    "_pdbx_struct_oper_list.matrix[1][1]\n_pdbx_struct_oper_list.matrix[1][2]\n_pdbx_struct_oper_list.matrix[1][3]\n"
    "_pdbx_struct_oper_list.vector[1]\n_pdbx_struct_oper_list.matrix[2][1]\n_pdbx_struct_oper_list.matrix[2][2]\n"
    "_pdbx_struct_oper_list.matrix[2][3]\n_pdbx_struct_oper_list.vector[2]\n_pdbx_struct_oper_list.matrix[3][1]\n"
    "_pdbx_struct_oper_list.matrix[3][2]\n_pdbx_struct_oper_list.matrix[3][3]\n_pdbx_struct_oper_list.vector[3]\n"
    "1 identity 1 0 0 0 0 1 0 0 0 0 1 0\n2 other -1 0 0 0 0 -1 0 0 0 0 1 5\n#\n"
    "loop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
    "_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n"
    "_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.auth_seq_id\n_atom_site.auth_asym_id\n"
    "ATOM 1 N N ALA A 1 1 2 3 1 A\nATOM 2 C CA ALA A 1 2.5 2 3 1 A\nATOM 3 C CA ALA B 1 20 2 3 1 B\n";

StructureOptions assembly(const char* name) {
  StructureOptions options;
  options.assembly = name;
  return options;
}

}  // namespace

TEST_CASE("an assembly of a PDB file: the copy is rotated and has a chain name of its own") {
#ifndef ESPDIFF_HAVE_GEMMI
  MESSAGE("SKIPPED: this build lacks gemmi");
  return;
#endif
  const ScratchFolder folder;
  const std::string path = folder.write("dimer.pdb", kDimerPdb);
  CHECK(read_structure(path).size() == 4);
  const Molecule dimer = read_structure(path, assembly("1"));
  REQUIRE(dimer.size() == 6);
  REQUIRE(dimer.residues.size() == 4);
  CHECK(dimer.residues[0].chain == "A");
  CHECK(dimer.residues[2].chain == "B");
  CHECK(dimer.atoms[2].element == "Zn");
  CHECK(dimer.positions[1].x == 2.5);
  CHECK(dimer.positions[4].x == -2.5);
  CHECK(dimer.positions[4].y == -2);
  CHECK(dimer.positions[4].z == 8);
  CHECK(dimer.radii.size() == 6);
}

TEST_CASE("an assembly of an mmCIF file, without occupancies and alternate locations") {
#ifdef ESPDIFF_HAVE_GEMMI
  const ScratchFolder folder;
  const std::string path = folder.write("dimer.cif", kCif);
  CHECK(read_structure(path).size() == 3);
  const Molecule dimer = read_structure(path, assembly("1"));
  REQUIRE(dimer.size() == 4);
  CHECK(dimer.residues[1].chain == "B");
  CHECK(dimer.positions[3].x == -2.5);
  CHECK(dimer.positions[3].z == 8);
#endif
}

TEST_CASE("an assembly that is not there is refused with those there are") {
#ifdef ESPDIFF_HAVE_GEMMI
  const ScratchFolder folder;
  const std::string path = folder.write("dimer.pdb", kDimerPdb);
  CHECK(message_of([&] { read_structure(path, assembly("3")); }) ==
        path + ": assembly: there is no assembly '3'; there are 1");
  const std::string plain =
      folder.write("plain.pdb", std::string(kDimerPdb).substr(std::string(kDimerPdb).find("ATOM")));
  CHECK(message_of([&] { read_structure(plain, assembly("1")); }).find("the file describes none (REMARK 350") !=
        std::string::npos);
  const std::string pqr = folder.write("a.pqr", "ATOM 1 CA ALA A 1 0.0 0.0 0.0 0.5 1.5\n");
  CHECK(message_of([&] { read_structure(pqr, assembly("1")); }).find("is a PQR file, which describes no assemblies") !=
        std::string::npos);
#endif
}

TEST_CASE("a PDB file with atomic numbers behind its columns is no PQR") {
#ifdef ESPDIFF_HAVE_GEMMI
  // As VMD's example deoxy.pdb has them.
  const ScratchFolder folder;
  const std::string path =
      folder.write("deoxy.pdb",
                   "ATOM      1 CB   MET     0     -11.092   7.121 -18.545  1.00 28.04   6         \n"
                   "ATOM      2 CG   MET     0     -10.026   7.899 -17.775  1.00 28.18   6         \n"
                   "ATOM      3 SD   MET     0      -9.946   7.480 -16.010  1.00 27.93  16         \n");
  const Molecule molecule = read_structure(path);
  REQUIRE(molecule.size() == 3);
  CHECK(molecule.charges.empty());
  CHECK(molecule.atoms[2].name == "SD");
  CHECK(molecule.atoms[2].element == "S");
  CHECK(molecule.positions[0].z == -18.545);
#endif
}

#ifdef ESPDIFF_HAVE_GEMMI
TEST_CASE("assemblies of more atoms or operations than are read are refused before they are made; so is a product") {
  const ScratchFolder folder;
  const auto message = [&](const std::string& operations, const char* name = "1") {
    const std::string cif = std::string(kCif).replace(std::string(kCif).find("oper_expression 1,2"), 19,
                                                      "oper_expression '" + operations + "'");
    const std::string path = folder.write("a.cif", cif);
    const std::string text = message_of([&] { read_structure(path, assembly(name)); });
    return text.find(path) == 0 ? text.substr(path.size()) : text;
  };
  CHECK(message("(1-2)") == "(nothing thrown)");
  CHECK(message("(1,2)") == "(nothing thrown)");
  // Once a list of 2^31 names, without end.
  CHECK(message("(1-2147483647)") ==
        ": the operations of assembly '1' are '(1-2147483647)'; names, or ranges such as (1-60), were expected");
  CHECK(message("(1-20000)") ==
        ": describes more than 10000 operations of assemblies, which is the most that are read");
  CHECK(message("2-1").find("; names, or ranges such as (1-60), were expected") != std::string::npos);
  // Once the first factor alone, in silence.
  CHECK(message("(1,2)(1-2)") ==
        ": the operations of assembly '1' are '(1,2)(1-2)', a product, which is not built; give a file with the "
        "assembly's coordinates");
  CHECK(message("(1,2)(1-2)", "2").find("there is no assembly '2'") != std::string::npos);
}

TEST_CASE("an assembly whose operations are not all described is refused, where gemmi would leave them out") {
  const ScratchFolder folder;
  const auto message = [&](const std::string& name, std::string text, const char* from, const char* to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    const std::string path = folder.write(name, text.replace(at, std::string(from).size(), to));
    const std::string refusal = message_of([&] { read_structure(path, assembly("1")); });
    return refusal.find(path) == 0 ? refusal.substr(path.size()) : refusal;
  };
  const auto contains = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  CHECK(message("a.cif", kCif, "oper_expression 1,2", "oper_expression 1,3") ==
        ": assembly '1' has 2 operations, and 1 are described with the chains that they apply to (REMARK 350, "
        "_pdbx_struct_assembly_gen, _pdbx_struct_oper_list)");
  // Once a conversion of NaN to an integer in gemmi: a model without atoms has no box.
  CHECK(contains(message("a.cif", kCif, "matrix[3][2]", "matrix[6][2]"), "has 2 operations, and 0 are described"));
  CHECK(contains(message("a.cif", kCif, "asym_id_list A", "asym_id_list X"), ": assembly '1' has no atoms: none are"));
  // Once one chain, or a wrong copy, in silence.
  const std::string rows = ": the operations of assembly '1' have ";
  CHECK(message("a.pdb", kDimerPdb, "REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        5.00000\n", "") ==
        rows + "an incomplete last one; rows BIOMT1, BIOMT2 and BIOMT3 of numbers in their columns were expected");
  CHECK(contains(message("a.pdb", kDimerPdb, "BIOMT2   1", "BIOMT3   1"),
                 (rows + "the line 'REMARK 350   BIOMT3").c_str()));
  CHECK(contains(message("a.pdb", kDimerPdb, " 5.00000", " 5.oooo0"), (rows + "the line").c_str()));
  CHECK(contains(message("a.pdb", kDimerPdb, "        5.00000", " 123456.00000  "), (rows + "the line").c_str()));
  CHECK(contains(message("a.pdb", kDimerPdb, "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n", ""),
                 "has 2 operations, and 0 are described with the chains"));
}

TEST_CASE("operations of assemblies that are no rotations, or lead far away, are refused") {
  const ScratchFolder folder;
  const auto message = [&](const char* operation) {
    const std::string path = folder.write(
        "a.cif", std::string(kCif).replace(std::string(kCif).find("-1 0 0 0 0 -1 0 0 0 0 1 5"), 25, operation));
    const std::string text = message_of([&] { read_structure(path, assembly("1")); });
    return text.find(path) == 0 ? text.substr(path.size()) : text;
  };
  const std::string not_rigid =
      ": operation '2' of assembly '1' is not a rotation with a shift of at most 10^6 Angstrom";
  for (const char* const operation :
       {"1 0 0 0 0 1 0 0 0 0 -1 5", "2 0 0 0 0 1 0 0 0 0 1 5", "1 0 0 0 0 1 0 0 0 0 1 1e7", "1 0 0 0 0 1 0 0 0 0 1 ?",
        "0 0 0 0 0 0 0 0 0 0 0 0"})
    CHECK(message(operation) == not_rigid);
  CHECK(message("0.5 -0.866 0 0 0.866 0.5 0 0 0 0 1 100") == "(nothing thrown)");
  // gemmi's grid over their box would take 2.4 GB.
  CHECK(message("1 0 0 2e4 0 1 0 2e4 0 0 1 0") ==
        ": assembly '1' spans 20001.5 x 20000 x 0 Angstrom with 4 atoms; its operations cannot be right");
}

TEST_CASE("an assembly with more atoms than are read is refused before it is made") {
  const ScratchFolder folder;
  std::string text;
  const int n_operations = 3000, n_atoms = 2000;
  text += "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n";
  char line[96];
  for (int k = 1; k <= n_operations; ++k) {
    for (int row = 0; row < 3; ++row) {
      std::snprintf(line, sizeof line, "REMARK 350   BIOMT%d%4d %9.6f %9.6f %9.6f  %13.5f\n", row + 1, k,
                    row == 0 ? 1. : 0., row == 1 ? 1. : 0., row == 2 ? 1. : 0., 1.0 * k);
      text += line;
    }
  }
  for (int i = 0; i < n_atoms; ++i) {
    std::snprintf(line, sizeof line, "ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n", i + 1,
                  i + 1, 0.5 * i, 0., 0.);
    text += line;
  }
  const std::string path = folder.write("a.pdb", text);
  CHECK(read_structure(path).size() == n_atoms);
  CHECK(message_of([&] { read_structure(path, assembly("1")); }) ==
        path + ": assembly '1' has 6000000 atoms, and at most 5000000 are read; give a smaller assembly");
}
#endif
