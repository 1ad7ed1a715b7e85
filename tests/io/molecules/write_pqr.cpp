// write_pqr.cpp: what is written is read back as the same molecule.
#include "io/molecules/write_pqr.h"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;  // NOLINT: a test of one header
using espdiff_test::message_of;
using espdiff_test::ScratchFolder;

namespace {

Molecule awkward() {
  Molecule m;
  m.name = "m";
  m.residues = {{"HIS", "A", 49, ' '}, {"TIP3W", "PROT", -3, 'B'}, {"NA ", "", 7, ' '}};
  m.atoms = {{"N", "N", 0, false}, {"HD11", "H", 0, false}, {"OH2", "O", 1, true}, {"C1*", "C", 2, true}};
  m.positions = {{69.66812, 33.705F, -4.794F}, {0, -1e-7, 1234.5679}, {-99.5, 1, 2}, {1.0F / 3, 2.0F / 3, 7}};
  for (Vec3d& p : m.positions) p = static_cast<Vec3d>(static_cast<Vec3f>(p));
  m.radii = {1.1F, 0, 1.768F, 1.0F / 3};
  m.charges = {-0.4157F, 0.25F, 1.0F / 7, 0};
  return m;
}

Molecule read_back(const Molecule& m) {
  const ScratchFolder folder;
  const std::string path = folder.file("m.pqr");
  std::ofstream out(path);
  write_pqr(out, m);
  out.close();
  StructureOptions options;
  options.include_water = true;
  return read_structure(path, options);
}

}  // namespace

TEST_SUITE_BEGIN("write_pqr");

TEST_CASE("numbers come back bit by bit, names as they were") {
  const Molecule m = awkward(), back = read_back(m);
  REQUIRE(back.size() == m.size());
  REQUIRE(back.residues.size() == m.residues.size());
  for (std::size_t i = 0; i < m.size(); ++i) {
    CAPTURE(i);
    CHECK(static_cast<Vec3f>(back.positions[i]) == static_cast<Vec3f>(m.positions[i]));
    CHECK(back.radii[i] == m.radii[i]);
    CHECK(back.charges[i] == m.charges[i]);
    CHECK(back.atoms[i].name == m.atoms[i].name);
    CHECK(back.atoms[i].residue == m.atoms[i].residue);
    CHECK(back.atoms[i].hetero == m.atoms[i].hetero);
  }
  for (std::size_t r = 0; r < m.residues.size(); ++r) {
    CHECK(back.residues[r].chain == m.residues[r].chain);
    CHECK(back.residues[r].number == m.residues[r].number);
    CHECK(back.residues[r].insertion_code == m.residues[r].insertion_code);
  }
  CHECK(back.residues[2].name == "NA_");
}

TEST_CASE("what fits stands in PDB's columns, which VMD reads") {
  Molecule m = awkward();
  m.residues = {{"HIS", "A", 49, ' '}, {"ALA", "A", -3, 'B'}, {"NA", "", 7, ' '}};
  m.positions = {{69.668, 33.705, -4.794}, {0, -1, 123.5}, {-99.5, 1, 2}, {0.25, 0.5, 7}};
  std::ostringstream out;
  write_pqr(out, m);
  CHECK(out.str().substr(0, 129) ==
        "ATOM      1  N   HIS A  49      69.668  33.705  -4.794 -0.4157 1.1\n"
        "ATOM      2 HD11 HIS A  49       0.000  -1.000 123.500 0.25 0\n");
  const Molecule back = read_back(m);
  for (std::size_t i = 0; i < m.size(); ++i) {
    CHECK(back.charges[i] == m.charges[i]);
    CHECK(back.atoms[i].name == m.atoms[i].name);
    CHECK(static_cast<Vec3f>(back.positions[i]) == static_cast<Vec3f>(m.positions[i]));
  }
  CHECK(back.residues[1].insertion_code == 'B');
  CHECK(back.residues[2].chain.empty());
}

TEST_CASE("coordinates of many digits leave names in PDB's columns, and a blank before each number") {
  Molecule m = awkward();
  m.residues = {{"HIS", "A", 49, ' '}, {"ALA", "A", -3, 'B'}, {"NA", "", 7, ' '}};
  CHECK(fits_pdb_columns(m));
  std::ostringstream out;
  write_pqr(out, m);
  CHECK(out.str().substr(0, 70) == "ATOM      1  N   HIS A  49     69.6681213  33.705  -4.794 -0.4157 1.1\n");
  const Molecule back = read_back(m);
  for (std::size_t i = 0; i < m.size(); ++i) {
    CHECK(back.charges[i] == m.charges[i]);
    CHECK(back.radii[i] == m.radii[i]);
    CHECK(back.atoms[i].name == m.atoms[i].name);
    CHECK(static_cast<Vec3f>(back.positions[i]) == static_cast<Vec3f>(m.positions[i]));
  }
}

TEST_CASE("names of more letters than PDB has columns do not fit") {
  Molecule m = awkward();
  CHECK_FALSE(fits_pdb_columns(m));
  m.residues[1] = {"TIP3", "P", 1, ' '};
  CHECK_FALSE(fits_pdb_columns(m));
  m.residues[1] = {"TIP", "P", 1, ' '};
  CHECK(fits_pdb_columns(m));
  m.residues[1].number = 10000;
  CHECK_FALSE(fits_pdb_columns(m));
}

TEST_CASE("serial numbers begin anew behind 99999, and residues stay whole") {
  Molecule m;
  m.name = "m";
  m.residues = {{"ALA", "A", 1, ' '}};
  const std::size_t n = 100002;
  m.atoms.assign(n, {"CA", "C", 0, true});
  for (std::size_t i = 0; i < n; ++i) m.positions.push_back({i < 50000 ? 0.0 : 15.125, 1, 2});
  m.radii.assign(n, 1);
  m.charges.assign(n, 0);
  std::ostringstream out;
  write_pqr(out, m);
  CHECK(out.str().find("HETATM99999  CA  ALA A   1     ") != std::string::npos);
  CHECK(out.str().find("HETATM    1  CA  ALA A   1      15.125") != std::string::npos);
}

TEST_CASE("a molecule without charges has charges of 0") {
  Molecule m = awkward();
  m.charges.clear();
  CHECK(read_back(m).charges == std::vector<float>(4, 0.0F));
}

TEST_CASE("radii that are not one an atom are refused") {
  Molecule m = awkward();
  m.radii.pop_back();
  std::ostringstream out;
  CHECK(message_of([&] { write_pqr(out, m); }) == "m: 3 radii and 4 charges for 4 atoms");
}

TEST_SUITE_END();
