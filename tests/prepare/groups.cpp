// groups.cpp: ions, haem, additives and ligands: which charges they get, and from where.
#include "prepare/charges/groups.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <tuple>

#include "align/residue_names.h"
#include "base/molecule/input_options.h"
#include "io/structures/structure_file.h"
#include "prepare/charges/ion_table.h"
#include "prepare/charges/open_babel.h"
#include "prepare/charges/pdb2pqr.h"
#include "support/test_data.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

std::string hetatm(int serial, const std::string& name, const std::string& residue, int number, double x, double y,
                   double z, const std::string& element) {
  char line[128];
  std::snprintf(line, sizeof line, "HETATM%5d %-4s %3s A%4d    %8.3f%8.3f%8.3f  1.00  0.00          %2s\n", serial,
                name.c_str(), residue.c_str(), number, x, y, z, element.c_str());
  return line;
}

/// Ethanol's heavy atoms under the name of a ligand.
std::string ethanol(const std::string& residue, int number, double x) {
  return hetatm(1, " C1", residue, number, x, 0, 0, "C") + hetatm(2, " C2", residue, number, x + 1.52, 0, 0, "C") +
         hetatm(3, " O1", residue, number, x + 2.0, 1.34, 0, "O");
}

Molecule molecule_of(const std::string& text) {
  const ScratchFolder folder;
  return read_structure(folder.write("in.pdb", text), {});
}

Groups charged(const Molecule& molecule, const ChargeOptions& options) {
  const std::vector<std::int32_t> no_files(molecule.residues.size(), -1);
  return charge_groups(molecule, group_sources(molecule, no_files, options), options, Progress());
}

double sum(const std::vector<float>& charges) {
  double total = 0;
  for (const float q : charges) total += static_cast<double>(q);
  return total;
}

}  // namespace

TEST_CASE("ion_parameters: names that say a state, elements in their common one, none for carbon") {
  CHECK(ion_parameters("ZN", "Zn")->charge == 2);
  CHECK(ion_parameters("ZN", "ZN")->radius == doctest::Approx(1.271));
  CHECK(ion_parameters("FE2", "Fe")->charge == 2);
  CHECK(ion_parameters("FE", "Fe")->charge == 3);
  CHECK(ion_parameters("CU1", "Cu")->charge == 1);
  CHECK(ion_parameters("CU", "Cu")->charge == 2);
  CHECK(ion_parameters("3CO", "Co")->charge == 3);
  CHECK(ion_parameters("CL", "Cl")->charge == -1);
  CHECK(ion_parameters("HO3", "Ho")->charge == 3);
  for (const auto& [name, element, charge] :
       {std::tuple("MN3", "Mn", 3), std::tuple("3NI", "Ni", 3), std::tuple("PT4", "Pt", 4), std::tuple("YB2", "Yb", 2)})
    CHECK(ion_parameters(name, element)->charge == charge);
  CHECK_FALSE(ion_parameters("LIG", "C"));
}

TEST_CASE("group_sources: CO and O2 are gases where they have two atoms, and CO of one atom is cobalt") {
  const std::string carbon_monoxide =
      hetatm(1, " C", "CO", 1, 0, 0, 0, "C") + hetatm(2, " O", "CO", 1, 1.13, 0, 0, "O");
  const std::string oxygen = hetatm(3, " O1", "O2", 2, 9, 0, 0, "O") + hetatm(4, " O2", "O2", 2, 10.2, 0, 0, "O");
  const Molecule molecule = molecule_of(carbon_monoxide + oxygen + hetatm(5, "CO", "CO", 3, 20, 0, 0, "CO"));
  CHECK(group_sources(molecule, {-1, -1, -1}, {}) ==
        std::vector<GroupSource>{GroupSource::kGas, GroupSource::kGas, GroupSource::kIon});
}

TEST_CASE("charge_groups: an ion gets its charge, glycerol is left out, a ligand waits for its file") {
  const Molecule molecule =
      molecule_of(hetatm(1, "ZN", "ZN", 1, 0, 0, 0, "ZN") + ethanol("GOL", 2, 9) + ethanol("LIG", 3, 20));
  const std::vector<std::int32_t> no_files(3, -1);
  ChargeOptions files;
  files.ligands_auto = false;
  CHECK(group_sources(molecule, no_files, files) ==
        std::vector<GroupSource>{GroupSource::kIon, GroupSource::kAdditive, GroupSource::kNone});
  CHECK(group_sources(molecule, {-1, 0, 0}, files)[1] == GroupSource::kNone);
  const Groups groups = charged(molecule, files);
  REQUIRE(groups.charged.size() == 1);
  CHECK(groups.charged.charges[0] == 2);
  CHECK(groups.lines == std::vector<std::string>{"ZN 1 of chain A: +2 e (common oxidation state)"});
  REQUIRE(groups.additives.size() == 1);
  CHECK(groups.additives[0].positions.size() == 3);
  CHECK(groups.additives[0].charge == 0);
}

TEST_CASE("charge_groups: haem has iron(II) and two propionates, -2 e") {
  std::string text;
  int serial = 0;
  for (const char* name :
       {"FE",  "NA",  "NB",  "NC",  "ND",  "C1A", "C2A", "C3A", "C4A", "C1B", "C2B", "C3B", "C4B", "C1C", "C2C",
        "C3C", "C4C", "C1D", "C2D", "C3D", "C4D", "CHA", "CHB", "CHC", "CHD", "CMA", "CAA", "CBA", "CGA", "O1A",
        "O2A", "CMB", "CAB", "CBB", "CMC", "CAC", "CBC", "CMD", "CAD", "CBD", "CGD", "O1D", "O2D"}) {
    const bool is_iron = std::string(name) == "FE";
    text += hetatm(serial, is_iron ? "FE" : std::string(" ") + name, "HEM", 1, 2.0 * serial, 0, 0,
                   is_iron ? "FE" : std::string(1, name[0]));
    ++serial;
  }
  const Groups groups = charged(molecule_of(text), {});
  REQUIRE(groups.charged.size() == 43);
  CHECK(sum(groups.charged.charges) == doctest::Approx(-2).epsilon(1e-5));
  for (const float radius : groups.charged.radii) CHECK(radius > 0.5F);
}

TEST_CASE("charge_groups: Open Babel makes a ligand's hydrogens and charges, unless it is not there") {
  const ChargeOptions options;
  const Molecule molecule = molecule_of(ethanol("LIG", 1, 0));
  setenv("ESPDIFF_OBABEL", "/nowhere/obabel", 1);
  CHECK(group_sources(molecule, {-1}, options)[0] == GroupSource::kNone);
  unsetenv("ESPDIFF_OBABEL");
  if (find_open_babel().empty()) {
    MESSAGE("SKIPPED: no Open Babel on PATH");
    return;
  }
  const Groups groups = charged(molecule, options);
  REQUIRE(groups.charged.size() == 9);
  CHECK(std::fabs(sum(groups.charged.charges)) < 1e-3);
  CHECK(groups.charged.charges[2] < -0.3F);
  for (std::size_t i = 0; i < 3; ++i) CHECK(norm(groups.charged.positions[i] - molecule.positions[i]) < 1e-9);
  for (std::size_t i = 3; i < 9; ++i) CHECK(groups.charged.atoms[i].element == "H");
  REQUIRE(groups.warnings.size() == 1);
  CHECK(groups.warnings[0] ==
        "the net charge of a ligand is a guess by Open Babel's rules, which no other source confirms: LIG 1 of chain A "
        "(+0 e); where one is wrong, give a MOL2 file of it");
  REQUIRE(groups.lines.size() == 1);
  CHECK(groups.lines[0].find("LIG 1 of chain A: +0 e, 6 hydrogens added, by Open Babel") != std::string::npos);
}

TEST_CASE("charge_groups: a net charge other than the usual one is set to it, with a warning") {
  const ChargeOptions options;
  if (find_open_babel().empty()) return;
  // Ethanol under the name of AMP, which usually has -2 e.
  const Groups groups = charged(molecule_of(ethanol("AMP", 1, 0)), options);
  CHECK(sum(groups.charged.charges) == doctest::Approx(-2).epsilon(1e-3));
  REQUIRE(groups.warnings.size() == 1);
  CHECK(groups.warnings[0].find("usually -2 e") != std::string::npos);
}

TEST_CASE("charge_groups: the file's formula confirms a ligand's bonds, or a warning says that they are wrong") {
  if (find_open_babel().empty()) return;
  const auto with_formula = [](const std::string& formula) {
    return charged(molecule_of("FORMUL   2  LIG    " + formula + "\n" + ethanol("LIG", 1, 0)), {});
  };
  const Groups right = with_formula("C2 H6 O");
  REQUIRE(right.lines.size() == 1);
  CHECK(right.lines[0].find("; bonds agree with the file's formula)") != std::string::npos);
  CHECK(right.warnings.size() == 1);
  // Acetaldehyde has the same heavy atoms.
  const Groups wrong = with_formula("C2 H4 O");
  CHECK(wrong.lines[0].find("formula") == std::string::npos);
  REQUIRE(wrong.warnings.size() == 2);
  CHECK(wrong.warnings[0] ==
        "LIG 1 of chain A has 6 hydrogens (without charge) by the bonds that Open Babel perceives, and 4 by the file's "
        "formula, so that its charges are wrong; give a MOL2 file of it, or its definition in the Chemical Component "
        "Dictionary (LIG.cif); CCP4's library has many: install it (Debian: refmac-dictionary)");
  // With heavy atoms missing it says nothing.
  CHECK(with_formula("C3 H8 O").warnings.size() == 1);
}

#ifdef ESPDIFF_HAVE_GEMMI
TEST_CASE("charge_groups: bonds of a definition that is given, or of CCP4's library, are taken as they are") {
  if (find_open_babel().empty()) return;
  const ScratchFolder folder;
  const std::string acetaldehyde =
      "data_LIG\nloop_\n_chem_comp_atom.comp_id\n_chem_comp_atom.atom_id\n_chem_comp_atom.type_symbol\n"
      "_chem_comp_atom.charge\nLIG C1 C 0\nLIG C2 C 0\nLIG O1 O 0\nloop_\n_chem_comp_bond.comp_id\n"
      "_chem_comp_bond.atom_id_1\n_chem_comp_bond.atom_id_2\n_chem_comp_bond.value_order\nLIG C1 C2 SING\n"
      "LIG C2 O1 DOUB\n";
  const Molecule molecule = molecule_of("FORMUL   2  LIG    C2 H4 O\n" + ethanol("LIG", 1, 0));
  ChargeOptions options;
  options.ligands = {folder.write("LIG.cif", acetaldehyde)};
  const Groups given = charged(molecule, options);
  REQUIRE(given.charged.size() == 7);
  CHECK(given.definitions == options.ligands);
  CHECK(given.lines[0] ==
        "LIG 1 of chain A: +0 e, 4 hydrogens added, by Open Babel (Gasteiger's charges, pH 7; bonds of LIG.cif, which "
        "agree with the file's formula)");
  CHECK(given.warnings.size() == 1);
  // Another ligand with names of these atoms has other bonds.
  const Molecule other =
      molecule_of(hetatm(1, " C1", "LIG", 1, 0, 0, 0, "C") + hetatm(2, " C2", "LIG", 1, 2.4, 0, 0, "C") +
                  hetatm(3, " O1", "LIG", 1, 1.2, 0.75, 0, "O"));
  CHECK(charged(other, options).definitions.empty());
  std::filesystem::create_directories(folder.file("monomers/l"));
  folder.write("monomers/l/LIG.cif", acetaldehyde);
  setenv("CLIBD_MON", folder.file("monomers").c_str(), 1);
  const Groups of_library = charged(molecule, {});
  setenv("CLIBD_MON", "", 1);
  CHECK(of_library.charged.charges == given.charged.charges);
  CHECK(of_library.definitions.empty());
  CHECK(of_library.lines[0].find("; bonds of CCP4's library, which agree with") != std::string::npos);
  CHECK(charged(molecule, {}).charged.size() == 9);
}
#endif

TEST_CASE("charge_groups: hydrogens that Open Babel does not keep are made anew") {
  if (find_open_babel().empty()) return;
  // A hydrogen in the middle of the carbons' bond.
  const Groups groups = charged(molecule_of(ethanol("LIG", 1, 0) + hetatm(4, " H1", "LIG", 1, 0.9, 0, 0, "H")), {});
  CHECK(std::fabs(sum(groups.charged.charges)) < 1e-3);
  REQUIRE(groups.charged.size() >= 9);
  CHECK(groups.charged.atoms[2].name == "O1");
}

TEST_CASE("group_sources: salt that touches nothing is left out, bound ions and ions of two charges stay") {
  const auto ca = [](double x) {
    return "ATOM      1  N   ALA A   1    " + std::string("   0.000   0.000   0.000  1.00  0.00           N\n") +
           "ATOM      2  CA  ALA A   1       1.460   0.000   0.000  1.00  0.00           C\n" +
           "ATOM      3  C   ALA A   1       2.000   1.420   0.000  1.00  0.00           C\n" +
           hetatm(4, "NA", "NA", 2, x, 0, 0, "NA") + hetatm(5, "CL", "CL", 3, -20, 0, 0, "CL") +
           hetatm(6, "ZN", "ZN", 4, 0, 20, 0, "ZN");
  };
  ChargeOptions options;
  options.ligands_auto = false;
  const std::vector<std::int32_t> no_files(4, -1);
  const auto bound = group_sources(molecule_of(ca(-4.0)), no_files, options);
  CHECK(bound[1] == GroupSource::kIon);
  CHECK(bound[2] == GroupSource::kAdditive);
  CHECK(bound[3] == GroupSource::kIon);
  CHECK(group_sources(molecule_of(ca(-6.0)), no_files, options)[1] == GroupSource::kAdditive);
  // Ions alone are what there is.
  const Molecule alone = molecule_of(hetatm(1, "NA", "NA", 2, 0, 0, 0, "NA") + hetatm(2, "CL", "CL", 3, 9, 0, 0, "CL"));
  CHECK(group_sources(alone, {-1, -1}, options)[0] == GroupSource::kIon);
}

TEST_CASE("prepare_molecule: a ligand alone is charged as beside a protein, without PDB2PQR") {
  const Molecule molecule = molecule_of(ethanol("LIG", 1, 0));
  ChargeOptions options;
  setenv("ESPDIFF_PDB2PQR", "/nowhere/pdb2pqr", 1);
  if (!find_open_babel().empty()) {
    const Prepared alone = prepare_molecule(molecule, options, {}, Progress());
    const Groups beside = charged(molecule, options);
    CHECK(alone.molecule.charges == beside.charged.charges);
    CHECK(alone.molecule.radii == beside.charged.radii);
    CHECK(alone.preparation.groups == beside.lines);
    CHECK(alone.preparation.warnings == beside.warnings);
    CHECK(alone.preparation.program == "Open Babel");
    CHECK(alone.preparation.force_field == "none");
    CHECK(alone.preparation.n_hydrogens_added == 6);
  }
  // An ion has no shape worth a comparison.
  const Molecule ion = molecule_of(hetatm(1, "ZN", " ZN", 1, 0, 0, 0, "ZN"));
  CHECK(message_of([&] { prepare_molecule(ion, options, {}, Progress()); }).find("and PDB2PQR, which assigns them") !=
        std::string::npos);
  unsetenv("ESPDIFF_PDB2PQR");
  setenv("ESPDIFF_OBABEL", "/nowhere/obabel", 1);
  if (!find_pdb2pqr().empty())
    CHECK(
        message_of([&] { prepare_molecule(molecule, options, {}, Progress()); })
            .find("has no charges, and no amino acids or nucleotides that PDB2PQR could charge, only LIG 1 of chain A; "
                  "let Open Babel charge ligands, which is not there: install it (Debian: openbabel) (ligands auto), "
                  "give a PQR, or charges (topology FILE or charges-from FILE)") != std::string::npos);
  unsetenv("ESPDIFF_OBABEL");
}

TEST_CASE("prepare_molecule: coarse-grained beads and those of shapes are named as such") {
  const auto beads = [](const std::string& residue, const std::string& first, const std::string& second) {
    const Molecule molecule =
        molecule_of(hetatm(1, first, residue, 1, 0, 0, 0, "C") + hetatm(2, second, residue, 1, 3, 0, 0, "C"));
    return message_of([&] { prepare_molecule(molecule, {}, {}, Progress()); });
  };
  const std::string rest =
      " of chain A), which have neither hydrogens nor charges of atoms; give the structure with all atoms, or a PQR "
      "with "
      "each bead's charge and radius";
  CHECK(beads("MET", " BB", " SC1").find(": has coarse-grained beads (BB of MET 1" + rest) != std::string::npos);
  CHECK(beads("SHA", " SHA", " SHB").find("beads") == std::string::npos);
  CHECK(beads("SHA", " SHA", "SHA").find(": has coarse-grained beads (SHA of SHA 1" + rest) != std::string::npos);
}

TEST_CASE("prepare_molecule: C-alpha atoms alone and backbones without side chains are named as such") {
  const auto error = [](const std::vector<std::string>& names) {
    std::string text;
    int serial = 0;
    for (int r = 1; r <= 6; ++r) {
      for (const std::string& name : names) {
        ++serial;
        text += hetatm(serial, name, "LEU", r, 1.5 * serial, 0, 0, name.substr(1, 1));
      }
    }
    return message_of([&] { prepare_molecule(molecule_of(text), {}, {}, Progress()); });
  };
  const std::string before = ": has no charges, and PDB2PQR cannot prepare it: it has ",
                    after =
                        "; give the structure with all atoms, or charges (topology FILE of a PSF or prmtop, or a PQR)";
  CHECK(error({" CA"}).find(before + "C-alpha atoms only" + after) != std::string::npos);
  CHECK(error({" N", " CA", " C", " O"}).find(before + "a backbone without side chains" + after) != std::string::npos);
  CHECK(error({" N", " CA", " C", " O", " CB", " CG"}).find("backbone") == std::string::npos);
}
