// read_gro.cpp: GROMACS' GRO files: names, nm, frames, cells, chains that the format does not name, damaged files.
#include "base/error.h"
#include "base/molecule/unit_cell.h"
#include "io/structures/structure_file.h"
#include "io/structures/structure_text.h"
#include "support/test_data.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

std::string atom(int residue, const char* residue_name, const char* name, int number, double x) {
  char line[80];
  std::snprintf(line, sizeof line, "%5d%-5s%5s%5d%8.3f%8.3f%8.3f\n", residue, residue_name, name, number, x, 0.2, -0.3);
  return line;
}

const std::string kTwo = "a title, t= 0.0\n    2\n" + atom(7, "ALA", "N", 1, 0.1) + atom(7, "ALA", "CA", 2, 0.25) +
                         "   3.00000   4.00000   5.00000\n";

}  // namespace

TEST_CASE("read_gro: Angstrom from nm, names, no charges, radii by element") {
  const Molecule m = structure_of("a.gro", kTwo);
  REQUIRE(m.size() == 2);
  CHECK(m.positions[1].x == doctest::Approx(2.5).epsilon(1e-12));
  CHECK(m.positions[1].z == doctest::Approx(-3.0).epsilon(1e-12));
  CHECK(m.atoms[1].name == "CA");
  CHECK(m.atoms[1].element == "C");
  CHECK(m.charges.empty());
  REQUIRE(m.residues.size() == 1);
  CHECK(m.residues[0].name == "ALA");
  CHECK(m.residues[0].number == 7);
  CHECK(m.residues[0].chain.empty());
}

TEST_CASE("read_gro: the columns' width follows the decimals, velocities are passed over, line ends of Windows") {
  const Molecule m =
      structure_of("a.gro", "wide\r\n1\r\n    1LIG     C1    1  -0.10125   0.20235  12.30345  0.123456\r\n 1 1 1\r\n");
  CHECK(m.positions[0].x == doctest::Approx(-1.0125).epsilon(1e-12));
  CHECK(m.positions[0].z == doctest::Approx(123.0345).epsilon(1e-12));
}

TEST_CASE("read_gro: frames are models, each with its cell") {
  const ScratchFolder scratch;
  std::string second = kTwo;
  second.replace(second.find("   3.00000"), std::string::npos, "   2.0 3.0 4.0 0 0 1.0 0 0.0 0.0\n");
  const StructureFile file(scratch.write("a.gro", kTwo + second + "\n \n"));
  CHECK(file.n_models() == 2);
  CHECK(file.unit_cell(1)->lengths == Vec3d{30, 40, 50});
  CHECK(file.unit_cell(1)->angles == Vec3d{90, 90, 90});
  CHECK(file.unit_cell(2)->lengths.y == doctest::Approx(std::sqrt(1000.0)));
  // a = (20, 0, 0) and b = (10, 30, 0)
  CHECK(file.unit_cell(2)->angles.z == doctest::Approx(std::atan2(30.0, 10.0) * 180 / 3.14159265358979));
  CHECK(file.read({2, true, false, {}}).size() == 2);
  CHECK(message_of([&] {
          file.read({3, true, false, {}});
        }).find("there is no model 3; the file has 2") != std::string::npos);
  CHECK(structure_of("a.gro", kTwo.substr(0, kTwo.find("   3.0")) + " 0 0 0\n").size() == 2);
}

TEST_CASE("read_gro: a bond leads on where numbers fall, and a number that is there already gets an insertion code") {
  const auto at = [](int residue, const char* residue_name, const char* name, double x) {
    return atom(residue, residue_name, name, 1, x);
  };
  // ALA 1 and SER 2 before LYS 1; twice SER 82, which only the second N tells apart
  const std::string bonded = at(1, "ALA", "N", 0) + at(1, "ALA", "C", 0.1) + at(2, "SER", "N", 0.23) +
                             at(2, "SER", "C", 0.3) + at(1, "LYS", "N", 0.43) + at(1, "LYS", "C", 0.5);
  const std::string twice = at(82, "SER", "N", 0.63) + at(82, "SER", "CA", 0.7) + at(82, "SER", "N", 0.9) +
                            at(82, "SER", "CA", 1.0) + at(82, "LEU", "N", 1.2);
  const Molecule m = structure_of("a.gro", "one\n11\n" + bonded + twice + " 9 9 9\n");
  REQUIRE(m.residues.size() == 6);
  const auto label = [&](std::size_t r) {
    return m.residues[r].chain + std::to_string(m.residues[r].number) + m.residues[r].insertion_code;
  };
  CHECK(label(0) == "A1 ");
  CHECK(label(1) == "A2 ");
  CHECK(label(2) == "A1A");
  CHECK(label(3) == "A82 ");
  CHECK(label(4) == "A82A");
  CHECK(label(5) == "A82B");
  CHECK(m.atoms[8].residue == 4);
  const Molecule apart = structure_of("a.gro", "one\n8\n" + bonded.substr(0, bonded.find(at(1, "LYS", "N", 0.43))) +
                                                   at(1, "LYS", "N", 0.9) + at(1, "LYS", "C", 1.0) +
                                                   at(1, "LIG", "N", 1.2) + at(1, "LIG", "N", 1.3) + " 9 9 9\n");
  REQUIRE(apart.residues.size() == 4);
  CHECK(apart.residues[2].chain == "B");
  CHECK(apart.residues[2].insertion_code == ' ');
  CHECK(apart.residues[3].insertion_code == 'A');  // with all of its atoms of one name
}

TEST_CASE("read_gro: where residues other than water start over, another chain begins") {
  const std::string atoms = atom(5, "ALA", "CA", 1, 0.1) + atom(6, "GLY", "CA", 2, 0.5) + atom(5, "ALA", "CA", 3, 1.1) +
                            atom(2, "SOL", "OW", 4, 2) + atom(7, "NA", "NA", 5, 2.5);
  const Molecule m = structure_of("a.gro", "two chains\n5\n" + atoms + " 3 3 3\n");
  REQUIRE(m.residues.size() == 4);  // without water
  CHECK(m.residues[0].chain == "A");
  CHECK(m.residues[1].chain == "A");
  CHECK(m.residues[2].chain == "B");
  CHECK(m.residues[3].chain == "B");
  const Molecule wrapped = structure_of(
      "a.gro", "wrapped\n2\n" + atom(99999, "POPC", "P", 1, 0.1) + atom(0, "POPC", "P", 2, 0.9) + " 3 3 3\n");
  CHECK(wrapped.residues[1].chain.empty());
}

TEST_CASE("read_gro: the line of a residue is told") {
  const ScratchFolder scratch;
  const StructureFile file(scratch.write("a.gro", kTwo));
  CHECK(file.line_of(1, {"ALA", "", 7, ' '}) == 3);
  CHECK(file.line_of(1, {"ALA", "", 8, ' '}) == 0);
}

TEST_CASE("read_gro: damaged files are refused with line and remedy") {
  const std::string head = kTwo.substr(0, kTwo.find("   3.0"));
  CHECK(
      structure_error("a.gro", head) ==
      "a.gro:4: the file ends after 2 atoms, and 2 atoms and a box were expected: it seems to be cut; write it again");
  CHECK(structure_error("a.gro", head.substr(0, head.find("    7ALA     CA"))).find("after 1 atoms") !=
        std::string::npos);
  std::string count = kTwo;
  count.replace(count.find("    2\n"), 6, "    1\n");
  CHECK(structure_error("a.gro", count).find("a.gro:4: the box of a GRO file is '7ALA     CA") == 0);
  CHECK(structure_error("a.gro", count).find("is the number of atoms above right?") != std::string::npos);
  std::string number = kTwo;
  number.replace(number.find("0.250"), 5, "0.2x0");
  CHECK(structure_error("a.gro", number).find("a.gro:4: x coordinate of atom 'CA' is '0.2x0'; three numbers of nm") ==
        0);
  std::string cut = kTwo;
  cut.replace(cut.find("  -0.300\n    7ALA     CA"), 9, "\n");
  CHECK(structure_error("a.gro", cut).find("a.gro:3: z coordinate of atom 'N' is ''") == 0);
  CHECK(structure_error("a.gro", kTwo + "next\n x\n").find("a.gro:7: the number of atoms in a GRO file is 'x'") == 0);
  CHECK(structure_error("a.gro", kTwo + "next\n 1\nALA\n 1 1 1\n")
            .find("a.gro:8: this line of a GRO file has no residue") == 0);
  CHECK(structure_error("a.gro", head + " 1 2\n").find("a.gro:5: the box of a GRO file is '1 2'") == 0);
  StructureOptions assembly;
  assembly.assembly = "1";
  CHECK(message_of([&] {
          structure_of("a.gro", kTwo, assembly);
        }).find("is a GRO file, which describes no assemblies") != std::string::npos);
}
