// read_pqr.cpp: PQR files, free format and columns, real and broken.
#include "io/structures/formats/read_pqr.h"

#include <filesystem>

#include "base/error.h"
#include "io/structures/structure_file.h"
#include "io/structures/structure_text.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;
using namespace espdiff_test;

namespace {

Molecule molecule_of_pqr(const std::string& text, const StructureOptions& options = {}) {
  const auto models = split_models(text, "f.pqr");
  return read_pqr("f.pqr", models.front(), options);
}

std::string pqr_error(const std::string& text) {
  return message_of([&] { molecule_of_pqr(text); });
}

}  // namespace

TEST_CASE("read_pqr: with and without chain") {
  const Molecule m = molecule_of_pqr(
      "REMARK x\nATOM      1  N   MET A   1      44.360  -3.155   8.971 -0.3000 1.8500\n"
      "HETATM 2 ZN ZN -7 1.5 +2 -3e1 2.0 0\nTER\nEND\n");
  REQUIRE(m.size() == 2);
  CHECK(m.positions[0] == Vec3d{44.360, -3.155, 8.971});
  CHECK(m.charges[0] == -0.3F);
  CHECK(m.radii[0] == 1.85F);
  CHECK(m.residues[0].chain == "A");
  CHECK(m.residues[0].name == "MET");
  CHECK(m.atoms[0].name == "N");
  CHECK_FALSE(m.atoms[0].hetero);
  CHECK(m.positions[1] == Vec3d{1.5, 2, -30});
  CHECK(m.radii[1] == 0);
  CHECK(m.residues[1].chain.empty());
  CHECK(m.residues[1].number == -7);
  CHECK(m.atoms[1].element == "Zn");
  CHECK(m.atoms[1].hetero);
  CHECK(m.atoms[1].residue == 1);
  CHECK(m.radii_origin == ValueOrigin::kFile);
  CHECK(m.name == "f.pqr");
}

TEST_CASE("read_pqr: insertion code and chain glued to the residue number") {
  const Molecule m = molecule_of_pqr(
      "ATOM 1 C ALA A 52A 0 0 0 0 1\nATOM 2 C ALA 52 0 0 0 0 1\nATOM 3 C ALA A52B 0 0 0 0 1\nATOM 4 C CHG A0 0 0 0 0 "
      "1\n");
  REQUIRE(m.residues.size() == 4);
  CHECK(m.residues[0].number == 52);
  CHECK(m.residues[0].insertion_code == 'A');
  CHECK(m.residues[1].insertion_code == ' ');
  CHECK(m.residues[2].chain == "A");
  CHECK(m.residues[2].number == 52);
  CHECK(m.residues[2].insertion_code == 'B');
  CHECK(m.residues[3].chain == "A");
  CHECK(m.residues[3].number == 0);
}

TEST_CASE("read_pqr: columns that run together are read by PDB's columns") {
  const Molecule m = molecule_of_pqr(
      "HETATM12345  HA  LYS A1000    -111.222-333.444-555.666  1.0000 2.0000\n"
      "ATOM      1 HD21AASN A 248    1105.0961037.7451054.659  0.3200 0.2245\n"
      "ATOM      1  CA  POPC1 248     105.096 -37.745-154.659-12.345610.2245\n");
  REQUIRE(m.size() == 3);
  CHECK(m.positions[0] == Vec3d{-111.222, -333.444, -555.666});
  CHECK(m.residues[0].chain == "A");
  CHECK(m.residues[0].number == 1000);
  CHECK(m.charges[0] == 1.0F);
  CHECK(m.radii[0] == 2.0F);
  CHECK(m.atoms[1].name == "HD21");
  CHECK(m.residues[1].name == "ASN");
  CHECK(m.positions[1] == Vec3d{1105.096, 1037.745, 1054.659});
  CHECK(m.residues[2].name == "POPC");
  CHECK(m.residues[2].chain == "1");
  CHECK(m.charges[2] == -12.3456F);
  CHECK(m.radii[2] == 10.2245F);
}

TEST_CASE("read_pqr: names that run together do not shift the fields") {
  const Molecule m = molecule_of_pqr(
      "ATOM   3777 HD21AASN A 248     105.096  37.745  54.659  0.3200 0.2245\n"
      "ATOM   3778  P   POPCM   7       1.000   2.000   3.000  0.3200 0.2245\n"
      "ATOM 3779 LONGNAME LIGAND 9 1 2 3 0 1\n");
  REQUIRE(m.size() == 3);
  CHECK(m.atoms[0].name == "HD21");
  CHECK(m.residues[0].name == "ASN");
  CHECK(m.residues[0].chain == "A");
  CHECK(m.residues[1].name == "POPC");
  CHECK(m.residues[1].chain == "M");
  CHECK(m.atoms[2].name == "LONGNAME");
  CHECK(m.residues[2].name == "LIGAND");
}

TEST_CASE("read_pqr: a glued serial number in free format") {
  const Molecule m = molecule_of_pqr("HETATM10000 C ALA 1 1 2 3 0.5 1.5\n");
  CHECK(m.positions[0] == Vec3d{1, 2, 3});
  CHECK(m.atoms[0].name == "C");
}

TEST_CASE("read_pqr: lines that cannot be distinguished are refused with their line number") {
  CHECK(pqr_error("REMARK\nATOM 1 N MET A 1 1.0 2.0 3.0 0.5\n") ==
        "f.pqr:2: this PQR line cannot be read: by blanks, the residue number is 'A'; by columns, the line is too "
        "short for PDB "
        "columns; expected: record, serial, atom, residue, [chain,] number, x, y, z, charge, radius, finite and "
        "separated by blanks");
  CHECK(contains(pqr_error("ATOM 1 N MET 1 1 2 3\n"), "f.pqr:1: this PQR line cannot be read: by blanks, 8 fields"));
  CHECK(contains(pqr_error("ATOM 1 N MET A 1 1.0 nan 3.0 0.5 1.0\n"), "by blanks, the y coordinate is 'nan'"));
  CHECK(contains(pqr_error("ATOM 1 N MET A 1 1.0 2.0 3.0 inf 1.0\n"), "by blanks, the charge is 'inf'"));
  CHECK(contains(pqr_error("ATOM 1 N MET A 1 1.0 2.0 3.0 0.5 1.0x\n"), "by blanks, the radius is '1.0x'"));
  CHECK(contains(pqr_error("ATOM 1 N MET A one 1.0 2.0 3.0 0.5 1.0\n"), "the residue number is 'one'"));
  CHECK(contains(pqr_error("ATOM      1  N   MET A   1      44.360  -3.155  *******  1.0000 1.8500\n"),
                 "the z coordinate is '*******'"));
  CHECK_THROWS_AS(molecule_of_pqr("ATOM\n"), FormatError);
}

TEST_CASE("read_pqr: radii and coordinates out of bounds") {
  CHECK(contains(pqr_error("ATOM 1 N MET A 1 1 2 3 0.5 -1.5\n"),
                 "f.pqr:1: radius of atom 'N' is -1.5; 0 or more was expected"));
  CHECK(contains(pqr_error("ATOM 1 N MET A 1 1 2e7 3 0.5 1.5\n"), "f.pqr:1: y coordinate of atom 'N' is 2e+07;"));
}

TEST_CASE("read_pqr: water and HETATM by choice") {
  const std::string text =
      "ATOM 1 N MET 1 1 2 3 0 1\nHETATM 2 ZN ZN 2 1 2 3 2 1\nHETATM 3 O HOH 3 1 2 3 0 1\nATOM 4 OH2 TIP3 4 1 2 3 0 1\n";
  StructureOptions options;
  CHECK(molecule_of_pqr(text, options).size() == 2);
  options.include_hetero = false;
  CHECK(molecule_of_pqr(text, options).size() == 1);
  options.include_water = true;
  CHECK(molecule_of_pqr(text, options).size() == 3);
  CHECK(message_of([&] { molecule_of_pqr("HETATM 3 O HOH 3 1 2 3 0 1\nATOM 1 O WAT 3 1 2 3 0 1\n"); }) ==
        "f.pqr: no atoms are left: 2 are water, which water keeps");
}

TEST_CASE("read_pqr: residues in file order; late hydrogens go home, a second molecule does not") {
  const Molecule m = molecule_of_pqr(
      "ATOM 1 N ALA 1 0 0 0 0 1\nATOM 2 N GLY 2 0 0 0 0 1\nATOM 3 H ALA 1 0 0 0 0 1\nATOM 4 N ALA 1 9 0 0 0 1\n"
      "ATOM 5 H ALA 1 9 0 0 0 1\n");
  REQUIRE(m.residues.size() == 3);
  const std::vector<std::int32_t> residues = {m.atoms[0].residue, m.atoms[1].residue, m.atoms[2].residue,
                                              m.atoms[3].residue, m.atoms[4].residue};
  CHECK(residues == std::vector<std::int32_t>{0, 1, 0, 2, 2});
}

TEST_CASE("read_pqr: real files") {
  // Sums: awk '/^(ATOM|HETATM)/{n++; q+=$(NF-1); r+=$NF; x+=$(NF-4)} END{printf "%d %.4f %.3f %.3f\n",n,q,r,x}' FILE
  struct Expected {
    const char* file;
    std::size_t n_atoms, n_residues;
    double charge, radius, x;
  };
  const Expected files[] = {{"pair_tim_maps/scTIM_chainA.pqr", 3778, 247, -3.0, 5789.776, 339953.714},
                            {"ref_apbs/1tca.pqr", 4624, 317, -1.0, 7134.627, -56507.049},
                            {"map_apbs_fas2/fas2.pqr", 906, 63, 4.053, 1440.107, -1193.859},
                            {"traj_adk/adk_open.pqr", 3341, 214, -4.0, 5115.504, -12244.876},
                            {"pqr_pdb2pqr/1AJJ_pH14_AMBER.pqr", 511, 37, -7.0008, 796.985, 5202.339}};
  for (const Expected& expected : files) {
    const auto path = real_input(expected.file);
    if (!path) return;
    CAPTURE(expected.file);
    const Molecule m = read_structure(*path);
    CHECK(m.size() == expected.n_atoms);
    CHECK(m.residues.size() == expected.n_residues);
    CHECK(sum(m.charges) == doctest::Approx(expected.charge).epsilon(1e-5));
    CHECK(sum(m.radii) == doctest::Approx(expected.radius).epsilon(1e-6));
    double x = 0;
    for (const Vec3d& p : m.positions) x += p.x;
    CHECK(x == doctest::Approx(expected.x).epsilon(1e-9));
  }
}

TEST_CASE("read_pqr: every PQR among the real inputs and in Debian's apbs-data is read whole") {
  std::vector<std::string> folders = {"/usr/share/apbs/examples"};
  if (!data_folder().empty()) folders.push_back(data_folder());
  std::size_t n_files = 0;
  for (const std::string& folder : folders) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".pqr") continue;
      CAPTURE(entry.path().string());
      std::size_t n_atoms = 0;
      std::istringstream lines(read_file(entry.path().string()));
      for (std::string line; std::getline(lines, line);)
        n_atoms += line.rfind("ATOM", 0) == 0 || line.rfind("HETATM", 0) == 0;
      StructureOptions options;
      options.include_water = true;
      const Molecule m = read_structure(entry.path().string(), options);
      CHECK(m.size() == n_atoms);
      CHECK(m.radii_origin == ValueOrigin::kFile);
      ++n_files;
    }
  }
  if (n_files == 0) MESSAGE("SKIPPED: neither real inputs nor Debian's apbs-data are installed");
}
