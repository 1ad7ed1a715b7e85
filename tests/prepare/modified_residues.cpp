// modified_residues.cpp: residues that PDB2PQR does not know keep their atoms, their place and their net charge.
#include "prepare/charges/modified_residues.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <sstream>

#include "align/residue_names.h"
#include "base/molecule/input_options.h"
#include "base/molecule/residue_label.h"
#include "io/molecules/select_atoms.h"
#include "io/structures/structure_file.h"
#include "prepare/charges/open_babel.h"
#include "prepare/charges/pdb2pqr.h"
#include "support/test_data.h"

using namespace espdiff;       // NOLINT: a test
using namespace espdiff_test;  // NOLINT: a test

namespace {

std::string record(int serial, const std::string& name, const std::string& residue, int number, const Vec3d& p,
                   const std::string& element) {
  char line[128];
  std::snprintf(line, sizeof line, "ATOM  %5d %-4s %3s A%4d    %8.3f%8.3f%8.3f  1.00  0.00          %2s\n", serial,
                name.c_str(), residue.c_str(), number, p[0], p[1], p[2], element.c_str());
  return line;
}

/// An amino acid's atoms, 1.5 Angstrom apart in a row.
std::string row_of_names(const std::string& residue, int number, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool has_digit_first = names[i].size() > 3;
    text += record(static_cast<int>(i), has_digit_first ? names[i] : " " + names[i], residue, number,
                   {1.5 * static_cast<double>(i), 0, 3.0 * number}, names[i].substr(0, 1));
  }
  return text;
}

Molecule molecule_from(const std::string& text) {
  const ScratchFolder folder;
  return read_structure(folder.write("in.pdb", text), {});
}

GroupSource source_of(const std::string& residue, const std::vector<std::string>& names, bool ligands_auto = false) {
  const Molecule molecule = molecule_from(row_of_names(residue, 1, names));
  return amino_acid_source(molecule, 0, atoms_of_residues(molecule)[0], ligands_auto);
}

const std::vector<std::string> kPhosphoserine = {"N", "CA", "CB", "OG", "C", "O", "P", "O1P", "O2P", "O3P"};

double net_charge(const Molecule& molecule) {
  double total = 0;
  for (const float q : molecule.charges) total += static_cast<double>(q);
  return total;
}

/// Residues 1 to 60 of T4 lysozyme; empty without the file or PDB2PQR, which it says.
std::string lysozyme_piece() {
  const auto path = real_input("t4l/3lzm_from_bcif.pdb");
  if (!path) return {};
  if (find_pdb2pqr().empty()) {
    MESSAGE("SKIPPED: no PDB2PQR; ", kPdb2pqrRemedy);
    return {};
  }
  std::string text;
  std::istringstream lines(read_file(*path));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) == 0 && std::stoi(line.substr(22, 4)) <= 60) text += line + "\n";
  }
  return text;
}

/// The text with a residue's name changed.
std::string renamed(const std::string& text, int number, const std::string& name) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (std::stoi(line.substr(22, 4)) == number) line.replace(17, 3, name);
    out += line + "\n";
  }
  return out;
}

Prepared prepared(const Molecule& molecule, bool ligands_auto = false) {
  ChargeOptions options;
  options.use_cache = false;
  options.ligands_auto = ligands_auto;
  return prepare_molecule(molecule, options, {}, Progress());
}

std::vector<std::size_t> atoms_of(const Molecule& molecule, int number) {
  const auto atoms = atoms_of_residues(molecule);
  for (std::size_t r = 0; r < atoms.size(); ++r) {
    if (molecule.residues[r].number == number) return atoms[r];
  }
  return {};
}

double charge_of(const Molecule& molecule, int number) {
  double total = 0;
  for (const std::size_t i : atoms_of(molecule, number)) total += static_cast<double>(molecule.charges[i]);
  return total;
}

constexpr int kSerine = 38;

}  // namespace

TEST_CASE("amino_acid_source: a phosphate needs its atoms, a modified name needs Open Babel, a torn end is left out") {
  CHECK(source_of("SER", {"N", "CA", "C", "O"}) == GroupSource::kNone);
  CHECK(source_of("ASH", {"N", "CA", "C", "O"}) == GroupSource::kNone);
  CHECK(source_of("SEP", kPhosphoserine) == GroupSource::kPhosphate);
  CHECK(source_of("SEP", {"N", "CA", "CB", "OG", "C", "O", "P"}) == GroupSource::kNone);
  CHECK(source_of("CME", {"N", "CA", "C", "O"}) == GroupSource::kNone);
  CHECK(source_of("CME", {"N", "CA", "C", "O"}, true) == GroupSource::kModified);
  CHECK(source_of("SER", {"N", "CA"}) == GroupSource::kTorn);
  CHECK(source_of("SER", {"N"}, true) == GroupSource::kTorn);
}

TEST_CASE("restore_residues: a phosphate takes the place of the hydroxyl hydrogen and brings -2 e") {
  const Molecule before = molecule_from(row_of_names("SEP", 7, kPhosphoserine));
  const std::vector<GroupSource> sources = {GroupSource::kPhosphate};
  Molecule known = with_known_residues(before, sources);
  CHECK(known.residues[0].name == "SER");
  CHECK(known.size() == 6);
  // A hydrogen 1 Angstrom from OG, the fourth atom.
  known.atoms.push_back({"HG", "H", 0, false});
  known.positions.push_back(known.positions[3] + Vec3d{0, 1, 0});
  known.radii.assign(7, 1);
  known.charges = {-0.4F, 0, 0, -0.49F, 0.55F, -0.15F, 0.49F};
  restore_residues(known, before, sources, {});
  CHECK(known.residues[0].name == "SEP");
  REQUIRE(known.size() == 10);
  CHECK(net_charge(known) == doctest::Approx(-2).epsilon(1e-5));
  for (const Atom& atom : known.atoms) CHECK(atom.name != "HG");
  CHECK(known.charges[6] == doctest::Approx(1.099));
  CHECK(known.charges[2] == doctest::Approx(0.005).epsilon(1e-3));
}

TEST_CASE("prepare_molecule: phosphoserine has -2 e more than serine; other residues keep their charges") {
  const std::string text = lysozyme_piece();
  if (text.empty()) return;
  const Prepared plain = prepared(molecule_from(text));
  const Molecule given = molecule_from(text);
  Vec3d og{}, cb{};
  for (const std::size_t i : atoms_of(given, kSerine)) {
    if (given.atoms[i].name == "OG") og = given.positions[i];
    if (given.atoms[i].name == "CB") cb = given.positions[i];
  }
  const Vec3d p = og + 1.6 / norm(og - cb) * (og - cb);
  const std::string with_phosphate = renamed(text, kSerine, "SEP") + record(901, " P", "SEP", kSerine, p, "P") +
                                     record(902, " O1P", "SEP", kSerine, p + Vec3d{1.5, 0, 0}, "O") +
                                     record(903, " O2P", "SEP", kSerine, p + Vec3d{0, 1.5, 0}, "O") +
                                     record(904, " O3P", "SEP", kSerine, p + Vec3d{0, 0, 1.5}, "O");
  const Prepared modified = prepared(molecule_from(with_phosphate));
  CHECK(net_charge(modified.molecule) == doctest::Approx(net_charge(plain.molecule) - 2).epsilon(1e-5));
  CHECK(charge_of(modified.molecule, kSerine) == doctest::Approx(-2).epsilon(1e-5));
  CHECK(charge_of(modified.molecule, kSerine + 1) == doctest::Approx(charge_of(plain.molecule, kSerine + 1)));
  CHECK(modified.preparation.groups ==
        std::vector<std::string>{"SEP 38 of chain A: a phosphate of -2 e (CHARMM's charges)"});
}

TEST_CASE("prepare_molecule: a residue under an unknown name gets its charges in the chain, by --ligands auto") {
  const std::string text = lysozyme_piece();
  if (text.empty()) return;
  const Molecule unknown = molecule_from(renamed(text, kSerine, "XSR"));
  CHECK(message_of([&] { prepared(unknown); }).find("XSR 38 of chain A (first atom N); let Open Babel make them") !=
        std::string::npos);
  if (find_open_babel().empty()) {
    MESSAGE("SKIPPED: no Open Babel on PATH");
    return;
  }
  const Prepared plain = prepared(molecule_from(text)), modified = prepared(unknown, true);
  CHECK(net_charge(modified.molecule) == doctest::Approx(net_charge(plain.molecule)).epsilon(1e-4));
  CHECK(atoms_of(modified.molecule, kSerine).size() == atoms_of(plain.molecule, kSerine).size());
  CHECK(modified.molecule.residues[kSerine - 1].name == "XSR");
  for (const int neighbour : {kSerine - 1, kSerine + 1})
    CHECK(charge_of(modified.molecule, neighbour) == doctest::Approx(charge_of(plain.molecule, neighbour)));
}

TEST_CASE("prepare_molecule: a residue is part of its chain by its bonds, whatever its backbone is named") {
  const std::string text = lysozyme_piece();
  if (text.empty() || find_open_babel().empty()) return;
  Molecule chromophore = molecule_from(renamed(text, kSerine, "XSR"));
  const std::vector<std::size_t> own = atoms_of(chromophore, kSerine);
  std::vector<std::size_t> backbone;
  for (const auto& [usual, other] : {std::pair("N", "N1"), {"CA", "CA1"}, {"C", "C3"}, {"O", "O3"}}) {
    for (const std::size_t i : own) {
      if (chromophore.atoms[i].name != usual) continue;
      backbone.push_back(i);
      chromophore.atoms[i].name = other;
    }
  }
  const auto found = peptide_backbone(chromophore, kSerine - 1, atoms_of_residues(chromophore));
  REQUIRE(found.has_value());
  CHECK(std::vector<std::size_t>{found->n, found->ca, found->c, found->o} == backbone);
  CHECK_FALSE(peptide_backbone(chromophore, kSerine, atoms_of_residues(chromophore)).has_value());
  const Prepared plain = prepared(molecule_from(text)), modified = prepared(chromophore, true);
  REQUIRE(modified.preparation.groups.size() == 1);
  CHECK(modified.preparation.groups[0] ==
        "XSR 38 of chain A: +0 e, in its chain, by Open Babel (Gasteiger's charges, pH 7)");
  CHECK(net_charge(modified.molecule) == doctest::Approx(net_charge(plain.molecule)).epsilon(1e-4));
  CHECK(atoms_of(modified.molecule, kSerine).size() == atoms_of(plain.molecule, kSerine).size());
  for (const int neighbour : {kSerine - 1, kSerine + 1})
    CHECK(charge_of(modified.molecule, neighbour) == doctest::Approx(charge_of(plain.molecule, neighbour)));
}

TEST_CASE("prepare_molecule: a residue of one atom is left out and listed") {
  const std::string text = lysozyme_piece();
  if (text.empty()) return;
  const std::string torn = row_of_names("SER", 61, {"N"});
  const Prepared whole = prepared(molecule_from(text)), with_end = prepared(molecule_from(text + torn));
  CHECK(with_end.molecule.size() == whole.molecule.size());
  REQUIRE(with_end.molecule.left_out.size() == 1);
  CHECK(with_end.molecule.left_out[0].residue.number == 61);
  CHECK(with_end.molecule.left_out[0].atoms.size() == 1);
}

TEST_CASE("prepare_molecule: a chain too short for PROPKA gets its usual states, and a note says so") {
  std::string text = lysozyme_piece();
  if (text.empty()) return;
  text.resize(text.find(" A  13 ") - 20);
  text.resize(text.rfind('\n') + 1);
  const Prepared brief = prepared(molecule_from(text));
  CHECK_FALSE(brief.preparation.propka);
  REQUIRE_FALSE(brief.preparation.notes.empty());
  CHECK(brief.preparation.notes.back().find("no PROPKA, which cannot use so short a chain") == 0);
  CHECK(brief.molecule.size() > molecule_from(text).size());
}

TEST_CASE("a nucleotide that no force field has gets charges within its chain; beside one it is a ligand") {
  const std::string path = "/usr/share/doc/theseus/examples/1s40.pdb.gz";
  if (!std::filesystem::exists(path) || find_open_babel().empty() || find_pdb2pqr().empty()) return;
  const Molecule entry = read_structure(path, {});
  std::vector<bool> is_dna;
  for (const Atom& atom : entry.atoms)
    is_dna.push_back(entry.residues[static_cast<std::size_t>(atom.residue)].chain == "B");
  Molecule dna = keep_atoms(entry, is_dna);
  ChargeOptions options;
  options.use_cache = false;
  const Prepared usual = prepare_molecule(dna, options, {}, Progress());
  {
    // A triphosphate that begins a chain has no atom P, and the nucleotide behind it a phosphate that is no end.
    Molecule begun = dna;
    begun.residues[0].name = "XTP";
    const auto of_residues = atoms_of_residues(begun);
    REQUIRE(residue_kinds(begun, of_residues)[0] == ResidueKind::kOther);
    CHECK(is_in_nucleic_chain(begun, 0, of_residues));
    const std::string first = espdiff::residue_label(begun.residues[0]);
    const Prepared triphosphate = prepare_molecule(begun, options, {}, Progress());
    REQUIRE(triphosphate.preparation.groups.size() == 1);
    CHECK(triphosphate.preparation.groups[0] ==
          first + ": +0 e, in its chain, by Open Babel (Gasteiger's charges, pH 7)");
    CHECK(net_charge(triphosphate.molecule) == doctest::Approx(net_charge(usual.molecule)).epsilon(1e-3));
    // Of a torn one there is too little to place the rest by.
    Molecule torn = dna;
    std::vector<bool> keep;
    for (const Atom& atom : torn.atoms) {
      const std::string name = normalized_atom_name(atom.name);
      keep.push_back(atom.residue != 0 || name == "O5'" || name == "C5'");
    }
    torn = keep_atoms(torn, keep);
    CHECK(nucleotide_source(torn, 0, atoms_of_residues(torn), true) == GroupSource::kTorn);
    CHECK(nucleotide_source(dna, 0, atoms_of_residues(dna), true) == GroupSource::kNone);
    const Prepared rest = prepare_molecule(torn, options, {}, Progress());
    REQUIRE(rest.molecule.left_out.size() == 1);
    CHECK(rest.molecule.left_out[0].residue.number == dna.residues[0].number);
    CHECK(net_charge(rest.molecule) == doctest::Approx(net_charge(usual.molecule) + 1).epsilon(1e-3));
  }
  dna.residues[4].name = "5XG";
  const auto atoms = atoms_of_residues(dna);
  CHECK(nucleotide_source(dna, 4, atoms, true) == GroupSource::kModified);
  CHECK(nucleotide_source(dna, 4, atoms, false) == GroupSource::kNone);
  CHECK(nucleotide_source(dna, 3, atoms, true) == GroupSource::kNone);
  CHECK(nucleotide_source(residue_alone(dna, 4, atoms[4]), 0, {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}, true) ==
        GroupSource::kOpenBabel);
  const Prepared modified = prepare_molecule(dna, options, {}, Progress());
  CHECK(modified.molecule.size() == usual.molecule.size());
  CHECK(net_charge(modified.molecule) == doctest::Approx(net_charge(usual.molecule)).epsilon(1e-3));
  CHECK(modified.molecule.residues[4].name == "5XG");
  REQUIRE(modified.preparation.groups.size() == 1);
  CHECK(modified.preparation.groups[0].find("5XG ") == 0);
  CHECK(modified.preparation.groups[0].find(": -1 e, in its chain, by Open Babel") != std::string::npos);
}

TEST_CASE("rename_residues: charged residues by the names of Insight II get those of the PDB") {
  Molecule molecule;
  int number = 5;
  for (const char* const name : {"AR+", "LY+", "AS-", "GL-", "ARG"})
    molecule.residues.push_back({name, "A", ++number, ' '});
  Preparation preparation;
  rename_residues(molecule, preparation);
  std::vector<std::string> names;
  for (const Residue& residue : molecule.residues) names.push_back(residue.name);
  CHECK(names == std::vector<std::string>{"ARG", "LYS", "ASP", "GLU", "ARG"});
  REQUIRE(preparation.renamed.size() == 4);
  CHECK(preparation.renamed[0] == "AR+ 6 of chain A as ARG");
}

TEST_CASE("rename_residues: the phosphate at the 5' end is left out with a warning, those within the chain stay") {
  const auto nucleotide = [](int number, double x) {
    return record(1, " P", "  G", number, {x, 0, 0}, "P") + record(2, " OP3", "  G", number, {x, 1.5, 0}, "O") +
           record(3, " O5'", "  G", number, {x + 1.6, 0, 0}, "O") +
           record(4, " O2'", "  G", number, {x + 3, 3, 0}, "O") +
           record(5, " O3'", "  G", number, {x + 4.4, 0, 0}, "O");
  };
  Molecule molecule = molecule_from(nucleotide(1, 0) + nucleotide(2, 6));
  Preparation preparation;
  rename_residues(molecule, preparation);
  CHECK(molecule.size() == 8);
  CHECK(molecule.atoms[0].name == "O5'");
  CHECK(preparation.warnings ==
        std::vector<std::string>{"the phosphate at the 5' end was left out (-2 e), since no force field of PDB2PQR has "
                                 "it: G 1 of chain A"});
}

TEST_CASE("rename_residues: CHARMM's nucleotides by their sugar, a protonated acid, GROMACS' oxygens at the end") {
  Molecule molecule = molecule_from(
      row_of_names("ADE", 1, {"C1'", "C3'", "N9"}) + row_of_names("GUA", 2, {"C1'", "O2'", "N9"}) +
      row_of_names("ASP", 3, {"N", "CA", "C", "O", "OD1", "OD2"}) +
      record(90, " HD1", "ASP", 3, {6.0, 0.96, 9.0}, "H") + row_of_names("GLU", 4, {"N", "CA", "C", "O1", "O2"}));
  Preparation preparation;
  rename_residues(molecule, preparation);
  CHECK(preparation.renamed ==
        std::vector<std::string>{"ADE 1 of chain A as DA", "GUA 2 of chain A as G", "ASP 3 of chain A as ASH"});
  CHECK(molecule.size() == 17);  // without the proton, which PDB2PQR places at OD2
  CHECK(molecule.atoms[15].name == "O");
  CHECK(molecule.atoms[16].name == "OXT");
  // A second oxygen at C, under any name; one of the side chain keeps its name.
  molecule = molecule_from(row_of_names("SER", 5, {"N", "CA", "C", "O", "OG"}) +
                           record(6, " O01", "SER", 5, {3.0, 1.2, 15.0}, "O"));
  rename_residues(molecule, preparation);
  CHECK(molecule.atoms[4].name == "OG");
  CHECK(molecule.atoms[5].name == "OXT");
}

TEST_CASE("rename_residues: nucleotides that Amber names as ends of chains get their usual names") {
  Molecule molecule =
      molecule_from(row_of_names("G5", 1, {"C1'", "O2'", "N9"}) + row_of_names("C3", 2, {"C1'", "O2'", "N1"}) +
                    row_of_names("DA5", 3, {"C1'", "N9"}) + row_of_names("A3", 4, {"C1'", "N9"}) +
                    row_of_names("SO4", 5, {"S", "O1"}) + row_of_names("X5", 6, {"C1'", "O2'", "N9"}));
  Preparation preparation;
  rename_residues(molecule, preparation);
  CHECK(preparation.renamed == std::vector<std::string>{"G5 1 of chain A as G", "C3 2 of chain A as C",
                                                        "DA5 3 of chain A as DA", "A3 4 of chain A as DA"});
}

TEST_CASE("foreign_atoms: of a whole residue; where its own are missing, they may be these") {
  const auto foreign = [](const std::vector<std::string>& names) {
    const Molecule molecule = molecule_from(row_of_names("CYS", 1, names));
    return foreign_atoms(molecule, 0, atoms_of_residues(molecule)[0]);
  };
  CHECK(foreign({"N", "CA", "C", "O", "CB", "SG", "P", "O1P"}) == std::vector<std::string>{"P", "O1P"});
  CHECK(foreign({"N", "CA", "C", "O", "CB", "SG", "OXT"}).empty());
  CHECK(foreign({"N", "CA", "C", "O", "CB", "S1"}).empty());
}

TEST_CASE("rename_residues: GROMACS' mass centres of virtual sites are left out with a note, metals stay") {
  Molecule molecule =
      molecule_from(row_of_names("LYS", 4, {"N", "CA", "C", "O", "NZ"}) + record(6, "MNZ1", "LYS", 4, {9, 0, 12}, "") +
                    record(7, "MNZ2", "LYS", 4, {9, 1, 12}, "") + record(8, "MN", " MN", 5, {20, 0, 0}, "MN"));
  Preparation preparation;
  rename_residues(molecule, preparation);
  REQUIRE(molecule.size() == 6);
  CHECK(molecule.atoms[5].name == "MN");
  CHECK(preparation.notes ==
        std::vector<std::string>{"2 mass centres of GROMACS, which are no atoms and have no charge, were left out "
                                 "(first MNZ1 of LYS 4 of chain A)"});
}
