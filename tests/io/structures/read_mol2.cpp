// MOL2 files: the atoms of the first molecule; what is refused, and with which words.
#include "io/structures/read_mol2.h"

#include <doctest/doctest.h>

#include "io/molecules/molecule_builder.h"
#include "support/test_data.h"

using espdiff::Mol2File;
using espdiff::read_mol2;
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

namespace {

const char* const kMol2Head = "@<TRIPOS>MOLECULE\nLIG\n3 2\n@<TRIPOS>ATOM\n";

/// What reading a file of this text is refused with, without its path.
std::string refusal(const std::string& text) {
  const ScratchFolder folder;
  const std::string path = folder.write("a.mol2", text);
  const std::string message = message_of([&] { read_mol2(path); });
  return message.find(path) == 0 ? message.substr(path.size()) : message;
}

}  // namespace

TEST_CASE("read_mol2: names, elements and positions of the first molecule's atoms") {
  const ScratchFolder folder;
  const std::string atoms = "# a comment\n1 C1 0.5 -1 2 C.ar 1 LIG 0.1\n\n2 H1 1e0 2 3 H\r\n3 N1 4 5 6 N.pl3 1 LIG\n";
  const Mol2File file = read_mol2(folder.write(
      "a.mol2", kMol2Head + atoms + "@<TRIPOS>BOND\n1 1 2 1\n@<TRIPOS>MOLECULE\nB\n@<TRIPOS>ATOM\n1 O1 0 0 0 O.3\n"));
  REQUIRE(file.atoms.size() == 3);
  CHECK(file.atoms[0].name == "C1");
  CHECK(file.atoms[0].element == "C");
  CHECK(file.atoms[0].position.y == -1);
  CHECK(file.atoms[1].element == "H");
  CHECK(file.atoms[2].element == "N");
  CHECK(file.atoms[2].position.z == 6);
}

TEST_CASE("read_mol2: lines that are no atoms are refused with their number") {
  const std::string expected = "; number, name, x, y, z and type were expected";
  CHECK(refusal(kMol2Head + std::string("1 C1 0 0 0\n")) == ":5: a MOL2 atom is '1 C1 0 0 0'" + expected);
  CHECK(refusal(kMol2Head + std::string("1 C1 0 0 0 C\n2 C2 0 zero 0 C\n")) ==
        ":6: a MOL2 atom is '2 C2 0 zero 0 C'" + expected);
  CHECK(refusal(kMol2Head + std::string("1 C1 0 nan 0 C\n")).find(":5: a MOL2 atom is '1 C1 0 nan 0 C'; ") == 0);
  CHECK(refusal(kMol2Head + std::string("1 C1 0 1e300 0 C.ar\n")) ==
        ":5: a MOL2 atom is '1 C1 0 1e300 0 C.ar'; coordinates of at most 10^6 Angstrom were expected");
  CHECK(refusal(kMol2Head) == ": has no @<TRIPOS>ATOM section; give a MOL2 file with atoms");
  CHECK(refusal("@<TRIPOS>MOLECULE\nLIG\n") == ": has no @<TRIPOS>ATOM section; give a MOL2 file with atoms");
  CHECK(refusal("ATOM 1 CA ALA A 1 0 0 0 0 1\n").find("; convert it, with hydrogens") != std::string::npos);
  CHECK(refusal("") == ": is empty; give a file with content");
}

TEST_CASE("read_mol2_bonds: atoms by their places, and lines that are no bonds") {
  const ScratchFolder folder;
  const auto bonds_of = [&](const std::string& bonds) {
    return espdiff::read_mol2_bonds(
        read_mol2(folder.write("a.mol2", kMol2Head + std::string("1 C1 0 0 0 C.3\n2 H1 0 0 1 H\n") + bonds)));
  };
  const auto bonds = bonds_of("@<TRIPOS>BOND\n     1     2    1 am\n@<TRIPOS>SUBSTRUCTURE\n1 2 3\n");
  REQUIRE(bonds.size() == 1);
  CHECK(bonds[0].a == 1);
  CHECK(bonds[0].b == 0);
  CHECK(bonds_of("").empty());
  for (const char* line : {"1 1 3 1", "1 0 1 1", "1 1 1 1", "1 1 2", "1 1 1.5 ar"}) {
    const std::string message = message_of([&] { bonds_of(std::string("@<TRIPOS>BOND\n") + line + "\n"); });
    CHECK_MESSAGE(message.find(":8: a MOL2 bond is '" + std::string(line) +
                               "'; number, two of the 2 atoms, and type were expected") != std::string::npos,
                  message);
  }
}

TEST_CASE("read_mol2: a line, or a name, of any length is shown in part") {
  const std::string message = refusal(kMol2Head + std::string("1 ") + std::string(1'000'000, 'C') + " 0 0\n");
  CHECK(message.size() < 300);
  CHECK(message.find("...'; number, name, x, y, z and type were expected") != std::string::npos);
}

TEST_CASE("read_mol2: more atoms than a molecule has are refused") {
  const ScratchFolder folder;
  std::string text = kMol2Head;
  text.reserve(std::size_t{12} * (espdiff::kMostAtoms + 10));
  for (std::size_t i = 0; i <= espdiff::kMostAtoms; ++i) text += "1 C 0 0 0 C\n";
  const std::string path = folder.write("many.mol2", text);
  CHECK(message_of([&] { read_mol2(path); }) ==
        path + ": has more than 5000000 atoms, which is the most that are read");
}
