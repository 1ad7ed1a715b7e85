// field_files.cpp: values of residues and atoms from tables.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "field/field_files.h"
#include "support/test_data.h"

using namespace espdiff_test;
using espdiff::FieldSide;
using espdiff::Molecule;
using espdiff::ValueTable;

namespace {

/// Two residues of chain A, of two atoms each.
Molecule two_residues() {
  Molecule m;
  m.name = "made.pdb";
  m.residues = {{"ALA", "A", 1, ' '}, {"GLY", "A", 2, 'B'}};
  for (int r = 0; r < 2; ++r) {
    for (const char* const name : {"N", "CA"}) {
      espdiff::Atom a;
      a.name = name;
      a.element = a.name.substr(0, 1);
      a.residue = r;
      m.atoms.push_back(a);
      m.positions.push_back({static_cast<double>(m.size()), 0, 0});
    }
  }
  return m;
}

}  // namespace

TEST_SUITE_BEGIN("field files");

TEST_CASE("residues get their values by chain, number and insertion code") {
  const ScratchFolder folder;
  const std::string path =
      folder.write("c.csv", "chain,residue_number,insertion_code,value\nA,1,,0.5\nA,2,B,-2\nB,9,,7\nB,10,,7\n");
  const auto field = ValueTable(path, false).values_of(two_residues(), FieldSide::kTarget);
  CHECK(field.atoms == std::vector<float>{0.5F, 0.5F, -2, -2});
  REQUIRE(field.notes.size() == 1);
  CHECK(field.notes[0] == path + ": 2 of its 4 residues are not in the target (made.pdb), the first is B 9");
}

TEST_CASE("files are named with their SHA-256") {
  const ScratchFolder folder;
  const std::string a = folder.write("a.csv", "abc"), b = folder.write("b.csv", "");
  const auto files = espdiff::SideFiles("residues", a + "," + b).with_sums();
  REQUIRE(files.size() == 2);
  CHECK(files[0].path == a);
  CHECK(files[0].sha256 == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(files[1].sha256 == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_CASE("a residue without a value is named, and any other column may hold the values") {
  const ScratchFolder folder;
  const std::string path = folder.write("c.csv", "chain,residue_number,residue_name,score\nA,1,ALA,3\n");
  const auto field = ValueTable(path, false).values_of(two_residues(), FieldSide::kSource);
  CHECK(field.atoms[1] == 3);
  CHECK(std::isnan(field.atoms[2]));
  REQUIRE(field.notes.size() == 1);
  CHECK(field.notes[0] ==
        path + ": 1 of 2 residues of the source (made.pdb) have no value there, the first is GLY 2B of chain A");
}

TEST_CASE("atoms get their values by name, and hydrogens their neighbour's") {
  const ScratchFolder folder;
  Molecule m = two_residues();
  m.atoms[1].name = "H";
  m.atoms[1].element = "H";
  const std::string path =
      folder.write("a.csv", "chain,residue_number,insertion_code,atom_name,value\nA,1,,N,4\nA,2,B,CA,5\n");
  const auto field = ValueTable(path, true).values_of(m, FieldSide::kSource);
  CHECK(field.atoms[0] == 4);
  CHECK(field.atoms[1] == 4);
  CHECK(std::isnan(field.atoms[2]));
  CHECK(field.atoms[3] == 5);
}

TEST_CASE("wrong tables are refused with file, line and remedy") {
  const ScratchFolder folder;
  const auto refused = [&](const std::string& content) {
    const std::string path = folder.write("c.csv", content);
    const std::string message =
        message_of([&] { ValueTable(path, false).values_of(two_residues(), FieldSide::kSource); });
    return message.substr(std::min(message.size(), path.size()));
  };
  CHECK(refused("chain,residue_number,value\nB,1,2\n") ==
        ": it has none of the residues of the source (made.pdb); it begins with B 1; check chains and numbers, or give "
        "a table for each state (SOURCE_FILE,TARGET_FILE)");
  CHECK(refused("chain,residue_number,value\nA,1,2\nA,1,3\n") ==
        ":3: A 1 stands in the table twice; leave one of its rows out");
  CHECK(refused("chain,residue_number,value\nA,1.5,2\n") == ":2: the residue number '1.5' is no whole number");
  CHECK(refused("chain,residue_number,a,b\nA,1,2,3\n") ==
        ": which column has the values? There are several besides those that name residues; call one 'value'");
  CHECK(refused("chain,residue_number\nA,1\n") ==
        ": which column has the values? There is none besides those that name residues; call one 'value'");
  CHECK(refused("chain,residue_number,value\nA,1,abc\n").rfind(":2:", 0) == 0);
  CHECK(message_of([&] { ValueTable(folder.file("none.csv"), false); }).find("none.csv") != std::string::npos);
}

TEST_SUITE_END();
