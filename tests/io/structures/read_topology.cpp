// Charges from PSF and prmtop files, as real programs wrote them, cut, and for other coordinates.
#include "io/structures/read_topology.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/formatted.h"
#include "io/files/file_kind.h"
#include "io/structures/structure_file.h"
#include "io/structures/structure_text.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::real_input;
using espdiff_test::replaced;
using espdiff_test::ScratchFolder;
using espdiff_test::sum;

namespace {

const char* const kPsf =
    "PSF\n\n       1 !NTITLE\n REMARKS made\n\n       2 !NATOM\n"
    "       1 U    1    MET  N    NH3   -0.300000       14.0070           0\n"
    "       2 U    1    MET  HT1  HC     0.330000        1.0080           0\n\n       1 !NBOND: bonds\n       1       "
    "2\n";
const char* const kPrmtop =
    "%VERSION  VERSION_STAMP = V0001.000\n%FLAG TITLE\n%FORMAT(20a4)\nmade\n%FLAG POINTERS\n%FORMAT(10I8)\n"
    "       2       1\n%FLAG ATOM_NAME\n%FORMAT(20a4)\nN   H1  \n%FLAG CHARGE\n%FORMAT(5E16.8)\n"
    "  2.90090000E+00  1.82223000E+01\n%FLAG RADII\n%FORMAT(5E16.8)\n  1.55000000E+00  1.30000000E+00\n";

}  // namespace

TEST_CASE("read_topology: a PSF's and a prmtop's atoms") {
  const ScratchFolder folder;
  const Topology psf = read_topology(folder.write("a.psf", kPsf));
  CHECK(psf.names == std::vector<std::string>{"N", "HT1"});
  CHECK(psf.charges == std::vector<float>{-0.3F, 0.33F});
  CHECK(psf.radii.empty());
  CHECK(kind_of_file(folder.file("a.psf")) == FileKind::kPsf);
  CHECK(kind_of_file(folder.file("")) == FileKind::kUnknownText);
  const Topology prmtop = read_topology(folder.write("a.prmtop", kPrmtop));
  CHECK(prmtop.names == std::vector<std::string>{"N", "H1"});
  CHECK(prmtop.charges[1] == doctest::Approx(1).epsilon(1e-6));
  CHECK(prmtop.radii == std::vector<float>{1.55F, 1.3F});
}

TEST_CASE("read_topology: cut and wrong files are refused with the line") {
  const ScratchFolder folder;
  const auto refused = [&](const char* name, const std::string& text) {
    const std::string path = folder.write(name, text);
    return message_of([&] { read_topology(path); }).substr(path.size());
  };
  const std::string psf = kPsf, prmtop = kPrmtop;
  CHECK(refused("b.psf", psf.substr(0, psf.find("       2 U"))).find("the PSF ends after 1 of 2 atoms") !=
        std::string::npos);
  CHECK(refused("c.psf", "PSF\n\n 1 !NATOM\n 1 U 1 MET N NH3 x 14\n").find(":4: a PSF atom is") == 0);
  CHECK(refused("d.psf", "PSF\n\n 1 !NTITLE\n").find("no !NATOM section") != std::string::npos);
  CHECK(refused("e.prmtop", prmtop.substr(0, prmtop.find("  2.9009"))).find("%FLAG CHARGE has 0 values for 2 atoms") !=
        std::string::npos);
  CHECK(refused("g.psf", "PSF\n\n 1 !NATOM\n 1 U 1 MET N NH3 1e39 14\n") ==
        ":4: the charge is 1e+39; -1e+06 to 1e+06 were expected");
  CHECK(refused("h.psf", "PSF\n\n 10000000 !NATOM\n") ==
        ":3: the number of atoms is 10000000; 1 to 5000000 were expected");
  CHECK(refused("i.prmtop", replaced(prmtop, "  1.30000000E+00", " -1.30000000E+00")) ==
        ":14: %FLAG RADII: value 2 is -1.3; 0 to 1000 were expected");
  CHECK(refused("j.prmtop", replaced(prmtop, "       2       1", "10000000       1")) ==
        ":5: the number of atoms is 10000000; 1 to 5000000 were expected");
  CHECK(refused("k.prmtop", replaced(prmtop, "(5E16.8)\n  2.9", "(5E9223372036854775807.8)\n  2.9"))
            .find("%FLAG CHARGE has 1 values for 2 atoms") != std::string::npos);
  CHECK(refused("k.top", "; by hand\n[ moleculetype ]\nProtein 3\n") ==
        ": this looks like a GROMACS topology, which is not read as a topology; `gmx editconf -f RUN.tpr -mead "
        "STATE.pqr` "
        "writes a PQR with the charges of a run input; give that");
  CHECK(refused("f.dx", "object 1 class gridpositions counts 1 1 1\n").find("not read as a topology") !=
        std::string::npos);
}

TEST_CASE("read_topology: a PSF of a million atoms is read in seconds, and a mistake in the last has its line") {
  const ScratchFolder folder;
  const std::size_t n = 1'000'000;
  std::string text = "PSF\n\n " + std::to_string(n) + " !NATOM\n";
  for (std::size_t i = 0; i + 1 < n; ++i) text += "1 S 1 ALA CA CT 0.5 12 0\n";
  const std::string good = folder.write("good.psf", text + "1 S 1 ALA CA CT 0.5 12 0\n");
  CHECK(read_topology(good).charges.size() == n);
  const std::string bad = folder.write("bad.psf", text + "1 S 1 ALA CA CT 1e9 12 0\n");
  CHECK(message_of([&] { read_topology(bad); }) ==
        bad + ":1000003: the charge is 1e+09; -1e+06 to 1e+06 were expected");
}

TEST_CASE("read_topology: ubiquitin's PSF gives the charges of its PQR; DHFR's prmtop a net charge of -11") {
  const auto psf = real_input("ubq/ubq.psf"), pdb = real_input("ubq/ubq.pdb"), pqr = real_input("ubq/ubq.pqr"),
             prmtop = real_input("box_dhfr_jac/JAC.prmtop");
  if (!psf) return;
  Molecule molecule = read_structure(*pdb, {1, true, true});
  take_topology(molecule, read_topology(*psf));
  const Molecule expected = read_structure(*pqr, {1, true, true});
  REQUIRE(molecule.charges.size() == expected.charges.size());
  CHECK(sum(molecule.charges) == doctest::Approx(sum(expected.charges)).epsilon(1e-6));
  const Topology dhfr = read_topology(*prmtop);
  CHECK(dhfr.charges.size() == 23558);
  CHECK(sum(dhfr.charges) == doctest::Approx(-11).epsilon(1e-4));
  CHECK(message_of([&] { take_topology(molecule, dhfr); }).find("has 23558 atoms, and") != std::string::npos);
}

TEST_CASE("read_topology_atoms: residues, chains and charges of a PSF") {
  const ScratchFolder folder;
  const Molecule molecule = read_topology_atoms(
      folder.write("a.psf",
                   "PSF\n\n       3 !NATOM\n       1 PROT 7    ALA  N    NH1  -0.470000  14.0070  0\n"
                   "       2 PROT 7    ALA  CA   CT1   0.070000  12.0110  0\n       3 PROT 8A   GLY  N  "
                   "  NH1  -0.400000  14.0070  0\n"));
  REQUIRE(molecule.size() == 3);
  CHECK(molecule.charges == std::vector<float>{-0.47F, 0.07F, -0.4F});
  REQUIRE(molecule.residues.size() == 2);
  CHECK(molecule.residues[1].name == "GLY");
  CHECK(molecule.residues[1].number == 8);
  CHECK(molecule.residues[1].insertion_code == 'A');
  CHECK(molecule.residues[1].chain == "PROT");
  CHECK(molecule.atoms[1].element == "C");
  CHECK(molecule.radii[0] > 1);
  CHECK(message_of([&] { read_topology_atoms(folder.write("a.pdb", "ATOM  \n")); }).find("not read as a topology") !=
        std::string::npos);
}

TEST_CASE("read_topology_atoms: a prmtop's residues, and radii by element where it has zeros") {
  const ScratchFolder folder;
  const std::string residues =
      "%FLAG RESIDUE_LABEL\n%FORMAT(20a4)\nALA LIG \n%FLAG RESIDUE_POINTER\n%FORMAT(10I8)\n       1       2\n";
  const std::string prmtop = kPrmtop + residues;
  const Molecule molecule = read_topology_atoms(folder.write("a.prmtop", prmtop));
  REQUIRE(molecule.size() == 2);
  REQUIRE(molecule.residues.size() == 2);
  CHECK(molecule.residues[0].name == "ALA");
  CHECK(molecule.residues[1].name == "LIG");
  CHECK(molecule.residues[1].number == 2);
  CHECK(molecule.residues[1].chain.empty());
  CHECK(molecule.atoms[1].name == "H1");
  CHECK(molecule.atoms[1].element == "H");
  CHECK(molecule.atoms[1].residue == 1);
  CHECK(molecule.charges[1] == doctest::Approx(1).epsilon(1e-6));
  CHECK(molecule.radii == std::vector<float>{1.55F, 1.3F});
  const std::string zeros =
      replaced(replaced(prmtop, "1.55000000E+00", "0.00000000E+00"), "1.30000000E+00", "0.00000000E+00");
  CHECK(read_topology_atoms(folder.write("b.prmtop", zeros)).radii == std::vector<float>{1.55F, 1.2F});
  const auto refused = [&](const std::string& text) {
    const std::string path = folder.write("c.prmtop", text);
    return message_of([&] { read_topology_atoms(path); }).substr(path.size());
  };
  CHECK(refused(replaced(prmtop, "       1       2\n", "       2       3\n")) ==
        ":20: %FLAG RESIDUE_POINTER: value 1 is '2'; the number of the residue's first atom was expected");
  CHECK(refused(replaced(prmtop, "       1       2\n", "       1       3\n")).find("value 2 is '3'; the number of") !=
        std::string::npos);
  CHECK(refused(replaced(prmtop, "       1       2\n", "       1       1\n")).find("value 2 is '1'; the number of") !=
        std::string::npos);
  CHECK(refused(replaced(prmtop, "ALA LIG ", "ALA ")).find("has fewer residues than RESIDUE_POINTER") !=
        std::string::npos);
  CHECK(refused(kPrmtop).find("the prmtop has no residues (%FLAG RESIDUE_POINTER)") != std::string::npos);
}

TEST_CASE("read_topology_atoms: chains of a prmtop by its bonds, where several peptides or nucleic acids are there") {
  const ScratchFolder folder;
  const auto section = [](const std::string& flag, const char* format, const std::string& values) {
    return "%FLAG " + flag + "\n%FORMAT(" + format + ")\n" + values + "\n";
  };
  // Two atoms a residue; bonds are pairs of atoms, from 0.
  const auto prmtop = [&](const std::string& names, const std::vector<std::array<int, 2>>& bonds) {
    const std::size_t n = names.size() / 4;
    std::string labels, firsts, charges, list;
    for (std::size_t i = 0; i < n; ++i) charges += "  0.00000000E+00";
    for (std::size_t i = 0; i < n; i += 2) {
      labels += "ALA ";
      firsts += formatted("%8d", static_cast<int>(i + 1));
    }
    for (const auto& [a, b] : bonds) list += formatted("%8d%8d%8d", 3 * a, 3 * b, 1);
    return "%VERSION  made\n" + section("POINTERS", "10I8", formatted("%8d", static_cast<int>(n))) +
           section("ATOM_NAME", "20a4", names) + section("CHARGE", "5E16.8", charges) +
           section("RESIDUE_LABEL", "20a4", labels) + section("RESIDUE_POINTER", "10I8", firsts) +
           section("BONDS_WITHOUT_HYDROGEN", "10I8", list);
  };
  const auto chains = [&](const std::string& text) {
    std::string all;
    for (const Residue& residue : read_topology_atoms(folder.write("a.prmtop", text)).residues)
      all += residue.chain.empty() ? "-" : residue.chain;
    return all;
  };
  const std::string two = "CA  C   CA  C   ", ligand = "C1  O1  ";
  CHECK(chains(prmtop(two + two + ligand, {{1, 2}, {5, 6}, {0, 1}})) == "AABBB");
  CHECK(chains(prmtop(two + two, {{1, 2}, {3, 4}, {6, 5}})) == "----");
  CHECK(chains(prmtop(ligand + two + ligand, {{3, 4}})) == "----");
  CHECK(chains(prmtop(ligand + two + "C4' O3' " + "C4' P   ", {{3, 4}, {7, 9}})) == "AAABB");
  CHECK(chains(prmtop(two + two, {})) == "----");
  // A bond to a residue that is not the next does not join: a disulfide between chains.
  CHECK(chains(prmtop(two + two, {{1, 2}, {5, 6}, {0, 6}})) == "AABB");
  const auto refused = [&](const std::array<int, 2>& bond) {
    const std::string path = folder.write("b.prmtop", prmtop(two, {bond}));
    return message_of([&] { read_topology_atoms(path); }).substr(path.size());
  };
  CHECK(refused({0, 4}) ==
        ":17: %FLAG BONDS_WITHOUT_HYDROGEN: value 2 is '12'; thrice the index of an atom was expected");
  CHECK(refused({-1, 1}).find("value 1 is '-3'") != std::string::npos);
}

TEST_CASE("read_topology_atoms: the solvated DHFR's prmtop and restart give its PDB's atoms") {
  const auto prmtop = real_input("box_dhfr_jac/JAC.prmtop");
  if (!prmtop) return;
  const Molecule all = read_topology_atoms(*prmtop);
  CHECK(all.size() == 23558);
  CHECK(all.residues[0].name == "MET");
  CHECK(all.atoms[0].name == "N");
  const auto n_water =
      std::count_if(all.residues.begin(), all.residues.end(), [](const Residue& r) { return r.name == "WAT"; });
  CHECK(n_water == 7023);
}
