// Preparations by PDB2PQR: against the program run by hand, and the rules for untidy entries.
#include "prepare/charges/pdb2pqr.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <thread>

#include "align/protonation.h"
#include "base/error.h"
#include "base/molecule/input_options.h"
#include "io/files/run_program.h"
#include "io/molecules/select_atoms.h"
#include "io/molecules/write_pqr.h"
#include "io/structures/structure_file.h"
#include "prepare/charges/cache.h"
#include "prepare/charges/open_babel.h"
#include "prepare/charges/separate_atoms.h"
#include "prepare/load_state.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;
using espdiff_test::real_input;
using espdiff_test::ScratchFolder;

namespace {

/// Says SKIPPED without the program.
bool has_pdb2pqr() {
  if (!find_pdb2pqr().empty()) return true;
  MESSAGE("SKIPPED: no PDB2PQR; ", kPdb2pqrRemedy);
  return false;
}

ChargeOptions without_cache() {
  ChargeOptions options;
  options.use_cache = false;
  return options;
}

Prepared prepare(const Molecule& molecule, const std::vector<std::string>& states = {}) {
  return prepare_molecule(molecule, without_cache(), states, Progress());
}

/// Residues of a chain of 3LZM as the text of a PDB file.
std::string lysozyme(int first, int last) {
  const auto path = real_input("t4l/3lzm_from_bcif.pdb");
  if (!path) return {};
  std::string text;
  std::istringstream lines(espdiff_test::read_file(*path));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) != 0) continue;
    const int number = std::stoi(line.substr(22, 4));
    if (number >= first && number <= last) text += line + "\n";
  }
  return text;
}

Molecule read(const ScratchFolder& folder, const std::string& text, const std::string& name = "in.pdb") {
  Molecule molecule = read_structure(folder.write(name, text), {1, true, false});
  molecule.name = name;
  return molecule;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace

TEST_CASE("prepare_molecule: charges, radii and places of PDB2PQR run by hand, to the last digit") {
  const auto path = real_input("pairs/4ake.pdb");
  if (!path || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  // By hand: chain A's lines as they stand in the entry, and the options of PDB2PQR's documentation.
  std::string chain_a;
  std::istringstream lines(espdiff_test::read_file(*path));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) == 0 && line[21] == 'A') chain_a += line + "\n";
  }
  const std::string input = folder.write("a.pdb", chain_a), output = folder.file("a.pqr");
  REQUIRE(run_program({{find_pdb2pqr(), "--ff=PARSE", "--titration-state-method=propka", "--with-ph=7.0",
                        "--keep-chain", input, output},
                       {},
                       {},
                       300,
                       {}})
              .status == 0);
  const Molecule by_hand = read_structure(output, {1, true, true});
  InputOptions options;
  options.both.select = "//A;polymer";
  options.charges.use_cache = false;
  const LoadedState state = load_state(StructureFile(*path), {}, options, Progress());
  REQUIRE(state.molecule.size() == by_hand.size());
  CHECK(state.molecule.charges == by_hand.charges);
  CHECK(state.molecule.radii == by_hand.radii);
  for (std::size_t i = 0; i < by_hand.size(); ++i) {
    if (state.molecule.positions[i] == by_hand.positions[i] && state.molecule.atoms[i].name == by_hand.atoms[i].name)
      continue;
    FAIL("atom ", i, " differs");
  }
  // The file that `espdiff prepare` writes has the same bits.
  std::ostringstream text;
  write_pqr(text, state.molecule);
  CHECK(read_structure(folder.write("ours.pqr", text.str()), {1, true, true}).charges == by_hand.charges);
  REQUIRE(state.preparation);
  CHECK(state.preparation->program.find("PDB2PQR v3") == 0);
  CHECK(state.preparation->net_charge == doctest::Approx(-3).epsilon(1e-5));
  CHECK(state.preparation->n_hydrogens_added == 1686);
}

TEST_CASE("prepare_molecule: given states are taken") {
  const std::string text = lysozyme(1, 40);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const Molecule molecule = read(folder, text);
  const Prepared own = prepare(molecule);
  std::vector<std::string> states = protonation_states(own.molecule);
  states.resize(molecule.residues.size());
  const auto residue = [&](int number) {
    return static_cast<std::size_t>(
        std::find_if(molecule.residues.begin(), molecule.residues.end(), [&](auto& r) { return r.number == number; }) -
        molecule.residues.begin());
  };
  states[residue(31)] = "HIE";
  states[residue(20)] = "ASH";
  states[residue(11)] = "GLH";
  states[residue(16)] = "LYN";
  const Prepared forced = prepare(molecule, states);
  const std::vector<std::string> got = protonation_states(forced.molecule);
  for (const int number : {31, 20, 11, 16}) CHECK(got[residue(number)] == states[residue(number)]);
  CHECK(forced.molecule.residues[residue(20)].name == "ASP");  // the name of the input
}

TEST_CASE("prepare_molecule: insertion codes, long numbers and chain names come back as they were") {
  const std::string text = lysozyme(1, 30);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  Molecule molecule = read(folder, text);
  const Prepared plain = prepare(molecule);
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) {
    molecule.residues[r].chain = "heavy";
    molecule.residues[r].number = r < 15 ? 12345 : 20000 + static_cast<int>(r);
    if (r < 15) molecule.residues[r].insertion_code = static_cast<char>('A' + r);
  }
  const Prepared odd = prepare(molecule);
  CHECK(odd.molecule.charges == plain.molecule.charges);
  REQUIRE(odd.molecule.residues.size() == molecule.residues.size());
  CHECK(odd.molecule.residues[3].insertion_code == 'D');
  CHECK(odd.molecule.residues[3].number == 12345);
  CHECK(odd.molecule.residues[20].chain == "heavy");
  CHECK(odd.molecule.residues[20].number == 20020);
}

TEST_CASE("prepare_molecule: selenomethionine is charged as methionine, and said") {
  const std::string text = lysozyme(1, 20);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const Prepared plain = prepare(read(folder, text));
  std::string selenium = replaced(text, "MET A", "MSE A");
  selenium = replaced(replaced(selenium, " SD  MSE", "SE   MSE"), "ATOM      1", "HETATM    1");
  const Molecule molecule = read(folder, selenium, "mse.pdb");
  const Prepared prepared = prepare(molecule);
  CHECK(prepared.molecule.charges == plain.molecule.charges);
  CHECK(prepared.preparation.renamed == std::vector<std::string>{"MSE 1 of chain A as MET", "MSE 6 of chain A as MET"});
}

TEST_CASE("prepare_molecule: a phosphorylated residue and a ligand get no charge; the ways on") {
  const std::string text = lysozyme(1, 20);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const std::string ligand =
      "HETATM 9000  PA  ATP A 301      60.000  60.000  60.000  1.00  0.00           P\n"
      "HETATM 9001 CA    CA A 302      70.000  60.000  60.000  1.00  0.00          CA\n";
  const Molecule molecule = read(folder, text + ligand);
  setenv("ESPDIFF_OBABEL", "/nowhere/obabel", 1);
  CHECK(message_of([&] { prepare(molecule); }) ==
        "in.pdb: 1 atom gets no charge from PDB2PQR's force field parse: ATP 301 of chain A (first atom PA); let Open "
        "Babel make them, which is not there: install it (Debian: openbabel) (ligands auto), give a MOL2 file of each "
        "with hydrogens (ligand FILE), charges for all atoms (topology FILE, charges-from FILE or a PQR), or drop them "
        "(leave-out (ATP))");
  const std::string phosphorylated = replaced(text, "TYR A", "PTR A");
  CHECK(message_of([&] { prepare(read(folder, phosphorylated, "ptr.pdb")); }).find("PTR") != std::string::npos);
  unsetenv("ESPDIFF_OBABEL");
  InputOptions options;
  options.charges.use_cache = false;
  options.leave_out = "(ATP,CA)";
  const LoadedState left = load_state(StructureFile(folder.file("in.pdb")), {}, options, Progress());
  CHECK(left.preparation.has_value());
}

TEST_CASE("prepare_molecule: a missing loop is listed, its ends stay uncharged; missing atoms are added") {
  const std::string text = lysozyme(1, 30);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  std::string gapped;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const int number = std::stoi(line.substr(22, 4));
    const bool in_gap = number >= 12 && number <= 15;
    const bool side_chain = number == 8 && line.substr(12, 4) != " N  " && line.substr(12, 4) != " CA " &&
                            line.substr(12, 4) != " C  " && line.substr(12, 4) != " O  ";
    if (!in_gap && !side_chain) gapped += line + "\n";
  }
  const Prepared prepared = prepare(read(folder, gapped));
  CHECK(prepared.preparation.gaps == std::vector<std::string>{"between GLU 11 and LYS 16 of chain A"});
  REQUIRE(prepared.preparation.added.size() >= 1);
  CHECK(prepared.preparation.added[0].find("of ARG 8 of chain A") != std::string::npos);
  for (std::size_t i = 0; i < prepared.molecule.size(); ++i) {
    const Residue& residue = prepared.molecule.residues[static_cast<std::size_t>(prepared.molecule.atoms[i].residue)];
    if (residue.number == 11) CHECK(prepared.molecule.atoms[i].name != "OXT");
  }
}

TEST_CASE("prepare_molecule: hydrogens under names that PDB2PQR does not know are placed anew, and a note says so") {
  const std::string text = lysozyme(1, 30);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  // All heavy atoms are there: where some are missing, PDB2PQR drops what it does not know.
  Molecule whole = prepare(read(folder, text)).molecule;
  whole.charges.assign(whole.size(), 0);
  whole.name = "whole.pdb";
  const Prepared plain = prepare(whole);
  std::size_t n_hydrogens = 0;
  std::string first;
  for (Atom& atom : whole.atoms) {
    if (atom.element != "H") continue;
    atom.name = "H" + std::to_string(100 + n_hydrogens++ % 30);
    if (first.empty()) first = atom.name;
  }
  const Prepared odd = prepare(whole);
  CHECK(odd.molecule.charges == plain.molecule.charges);
  CHECK(odd.molecule.positions == plain.molecule.positions);
  REQUIRE(odd.preparation.notes.size() == 1);
  CHECK(odd.preparation.notes[0] == "the file's " + std::to_string(n_hydrogens) +
                                        " hydrogens were placed anew, since PDB2PQR does not know " + first +
                                        " of MET 1 of chain A; PROPKA decides the protonation");
  // A heavy atom is not dropped.
  whole.atoms.back().name = "XX9";
  whole.atoms.back().element = "C";
  ChargeOptions options = without_cache();
  options.force_field = "charmm";
  options.ligands_auto = false;
  const Residue& last = whole.residues.back();
  const std::string number = std::to_string(last.number);
  CHECK(message_of([&] { prepare_molecule(whole, options, {}, Progress()); }) ==
        "whole.pdb: has no charges, and PDB2PQR cannot prepare it: XX9 of " + last.name + " " + number +
            " of chain A is none of its residue's atoms by this name; name it as the PDB does, leave it out (leave-out "
            "//A/" +
            number + "/XX9), or give charges (topology FILE of a PSF or prmtop, or a PQR)");
}

TEST_CASE("prepare_molecule: of alternate locations the better occupied one is charged") {
  const std::string text = lysozyme(1, 20);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  std::string alternate;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool moves = line.substr(17, 3) == "PHE" && line.substr(12, 4) == " CZ ";
    if (!moves) {
      alternate += line + "\n";
      continue;
    }
    for (const char location : {'A', 'B'}) {
      std::string copy = line;
      copy[16] = location;
      copy.replace(54, 6, location == 'A' ? "  0.30" : "  0.70");
      if (location == 'A') copy.replace(30, 8, "   0.000");
      alternate += copy + "\n";
    }
  }
  const Prepared plain = prepare(read(folder, text)), chosen = prepare(read(folder, alternate, "alternate.pdb"));
  REQUIRE(chosen.molecule.size() == plain.molecule.size());
  for (std::size_t i = 0; i < plain.molecule.size(); ++i)
    CHECK(chosen.molecule.positions[i] == plain.molecule.positions[i]);
}

TEST_CASE("prepare_molecule: the cache gives the same, and a damaged entry is not taken") {
  const std::string text = lysozyme(1, 20);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  setenv("XDG_CACHE_HOME", folder.file("cache").c_str(), 1);
  const Molecule molecule = read(folder, text);
  ChargeOptions options;
  const Prepared first = prepare_molecule(molecule, options, {}, Progress());
  CHECK(!first.preparation.from_cache);
  const Prepared second = prepare_molecule(molecule, options, {}, Progress());
  CHECK(second.preparation.from_cache);
  CHECK(second.molecule.charges == first.molecule.charges);
  CHECK(second.preparation.program == first.preparation.program);
  options.ph = 3;
  CHECK(!prepare_molecule(molecule, options, {}, Progress()).preparation.from_cache);
  options.ph = 7;
  for (const auto& entry : std::filesystem::directory_iterator(cache_folder())) {
    std::string content = espdiff_test::read_file(entry.path().string());
    content[content.size() / 2] ^= 1;
    std::ofstream(entry.path()) << content;
  }
  const Prepared third = prepare_molecule(molecule, options, {}, Progress());
  CHECK(!third.preparation.from_cache);
  CHECK(third.molecule.charges == first.molecule.charges);
  unsetenv("XDG_CACHE_HOME");
}

TEST_CASE("prepare_molecule: no program, nothing to charge, cancelled") {
  const ScratchFolder folder;
  const Molecule ion = read(folder, "HETATM    1 CA    CA A   1       0.000   0.000   0.000  1.00  0.00          CA\n");
  setenv("ESPDIFF_PDB2PQR", "/no/such/program", 1);
  CHECK(message_of([&] { prepare(ion); }) ==
        "in.pdb: has no charges, and PDB2PQR, which assigns them, is not there; install it (Debian: pdb2pqr; PyPI: "
        "pdb2pqr)");
  unsetenv("ESPDIFF_PDB2PQR");
  if (!has_pdb2pqr()) return;
  CHECK(message_of([&] { prepare(ion); }).find("no amino acids or nucleotides that PDB2PQR could charge, only CA ") !=
        std::string::npos);
  const std::string text = lysozyme(1, 40);
  if (text.empty()) return;
  Progress progress;
  progress.request_cancel();
  CHECK_THROWS_AS(prepare_molecule(read(folder, text), without_cache(), {}, progress), Cancelled);
}

TEST_CASE("prepare_molecule: the program gets fixed names in a folder of its own, which does not stay") {
  const std::string text = lysozyme(1, 40);
  if (text.empty()) return;
  const ScratchFolder folder;
  const Molecule molecule = read(folder, text, "-it's $(touch here).pdb");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.file(""));
  std::filesystem::create_directory("-temporary folder");
  setenv("TMPDIR", "-temporary folder", 1);
  const auto program = [&](const std::string& body) {
    const std::string path = folder.write("a program", "#!/bin/sh\n" + body + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    setenv("ESPDIFF_PDB2PQR", path.c_str(), 1);
  };
  program("for word; do echo \"$word\"; done > '" + folder.file("words") + "'; pwd >> '" + folder.file("words") +
          "'; stat -c %a . >> '" + folder.file("words") + "'; exit 1");
  const std::string unknown = "PDB2PQR cannot prepare it: its reason is not known here, and pdb2pqr30 prints it when";
  CHECK(message_of([&] { prepare(molecule); }).find(unknown) != std::string::npos);
  std::istringstream words(espdiff_test::read_file(folder.file("words")));
  std::vector<std::string> lines;
  for (std::string line; std::getline(words, line);) lines.push_back(line);
  REQUIRE(lines.size() == 8);
  CHECK(lines[0] == "--ff=PARSE");
  const std::string& place = lines[6];
  CHECK(place.find(folder.file("") + "-temporary folder/espdiff-") == 0);
  CHECK(lines[4] == place + "/input.pdb");
  CHECK(lines[5] == place + "/output.pqr");
  CHECK(lines[7] == "700");
  const auto is_empty = [&] { return std::filesystem::is_empty("-temporary folder"); };
  CHECK(is_empty());
  program("echo 'CRITICAL: /tmp/gone/output.pqr: foreign words'; exit 1");
  const std::string own = message_of([&] { prepare(molecule); });
  CHECK(own.find(unknown) != std::string::npos);
  CHECK(own.find("foreign") == std::string::npos);
  program("echo 'WARNING:Unable to find amino or nucleic acid definition for ZN. Parsing as new residue.'; exit 1");
  CHECK(message_of([&] { prepare(molecule); }).find(unknown) != std::string::npos);
  program("echo 'Unable to debump biomolecule. Found gap in biomolecule structure for atom HZ3 LYN'; exit 1");
  CHECK(message_of([&] { prepare(molecule); }).find("it: an atom of the file is none of its residue's atoms") !=
        std::string::npos);
  program(
      "echo 'WARNING:Residue ASN A 2 has non-integer charge:  -0.3'; echo 'WARNING:Residue ILE A 3 has non-integer "
      "charge:  0.1'; echo 'ValueError: non-integer charge'; exit 1");
  CHECK(message_of([&] {
          prepare(molecule);
        }).find("it: the sum of the charges is not a whole number (ASN 2 of chain A, ILE 3 of chain A); complete") !=
        std::string::npos);
  program("echo 'Too few atoms present to reconstruct or cap residue ILE A 3 in structure! This error is'; exit 1");
  CHECK(message_of([&] {
          prepare(molecule);
        }).find("it: a residue has too few atoms to place the missing ones by (ILE 3 of chain A); complete") !=
        std::string::npos);
  program("truncate -s 600M output.pqr; sleep 60");
  CHECK(message_of([&] { prepare(molecule); }).find("PDB2PQR wrote more than 512 MB and was ended") !=
        std::string::npos);
  CHECK(is_empty());
  program("sleep 60");
  Progress* handle = nullptr;
  Progress progress([&](const std::string&, double) { handle->request_cancel(); });
  handle = &progress;
  std::thread cancel([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    progress.request_cancel();
  });
  CHECK_THROWS_AS(prepare_molecule(molecule, without_cache(), {}, progress), Cancelled);
  cancel.join();
  CHECK(is_empty());
  unsetenv("ESPDIFF_PDB2PQR");
  unsetenv("TMPDIR");
  std::filesystem::current_path(before);
  CHECK_FALSE(std::filesystem::exists(folder.file("here")));
}

TEST_CASE("coordinates in nm and a chain on top of itself are refused before PDB2PQR, which moves atoms for minutes") {
  const auto path = real_input("pqr_pdb2pqr/1AJJ.pdb");
  if (!path || !has_pdb2pqr()) return;
  const Molecule right = read_structure(*path, {1, false, false});
  Molecule in_nm = right, doubled = right;
  for (Vec3d& p : in_nm.positions) p = 0.1 * p;
  const std::size_t n_residues = right.residues.size();
  for (std::size_t r = 0; r < n_residues; ++r) {
    doubled.residues.push_back(right.residues[r]);
    doubled.residues.back().chain = "B";
  }
  for (std::size_t i = 0; i < right.size(); ++i) {
    doubled.atoms.push_back(right.atoms[i]);
    doubled.atoms.back().residue += static_cast<std::int32_t>(n_residues);
    doubled.positions.push_back(right.positions[i] + Vec3d{0.1, 0, 0});
    doubled.radii.push_back(right.radii[i]);
  }
  CHECK_NOTHROW(require_separate_atoms(right));
  for (const Molecule* molecule : {&in_nm, &doubled}) {
    const std::string message = message_of([&] { prepare(*molecule); });
    CAPTURE(message);
    CHECK(message.find(" atoms lie within 0.5 A of another (N of ") != std::string::npos);
    CHECK(message.find("): give coordinates in Angstrom, not in nm, and each chain and model once") !=
          std::string::npos);
  }
}

TEST_CASE("prepare_molecule: hydrogens on top of each other are placed anew") {
  const auto path = real_input("pqr_pdb2pqr/1AJJ.pdb");
  if (!path || !has_pdb2pqr()) return;
  const Molecule bare = read_structure(*path, {1, false, false, {}});
  const Prepared usual = prepare(bare);
  Molecule rough = usual.molecule;
  rough.charges.clear();
  std::vector<std::size_t> hydrogens;
  for (std::size_t i = 0; i < rough.size(); ++i) {
    if (rough.atoms[i].element == "H" && rough.atoms[i].name.substr(0, 2) == "HB") hydrogens.push_back(i);
  }
  REQUIRE(hydrogens.size() > 20);
  CHECK(misplaced_hydrogens(rough).empty());
  for (std::size_t k = 0; k + 1 < 12; k += 2)
    rough.positions[hydrogens[k]] = rough.positions[hydrogens[k + 1]] + Vec3d{0.1, 0, 0};
  CHECK(misplaced_hydrogens(rough).find("12 atoms lie within 0.5 A of another (HB2 of ") == 0);
  const Prepared anew = prepare(rough);
  REQUIRE(anew.molecule.size() == usual.molecule.size());
  const auto places = [](const Molecule& molecule) {
    std::map<std::pair<std::int32_t, std::string>, Vec3d> at;
    for (std::size_t i = 0; i < molecule.size(); ++i)
      at[{molecule.atoms[i].residue, molecule.atoms[i].name}] = molecule.positions[i];
    return at;
  };
  const auto before = places(usual.molecule), after = places(anew.molecule);
  for (const auto& placed : before) {
    CAPTURE(placed.first.second);
    CHECK(norm(after.at(placed.first) - placed.second) < 1e-6);
  }
  const auto& notes = anew.preparation.notes;
  CHECK(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("hydrogens were placed anew, since 12 atoms lie within 0.5 A of another (HB2 of ") !=
           std::string::npos;
  }));
}

TEST_CASE("load_state: the target takes the source's protonation states") {
  const auto path = real_input("pairs/4ake.pdb");
  if (!path || !has_pdb2pqr()) return;
  InputOptions options;
  options.both.select = "//A;polymer";
  options.charges.same_protonation = true;
  options.charges.use_cache = false;
  const StructureFile file(*path);
  InputOptions acid = options;
  acid.charges.ph = 3;
  const LoadedState source = load_state(file, {{}, StateRole::kSource}, acid, Progress());
  StateRequest request{{}, StateRole::kTarget};
  request.source = &source.molecule;
  const LoadedState target = load_state(file, request, options, Progress());
  std::vector<std::int32_t> target_of;
  for (std::size_t r = 0; r < source.molecule.residues.size(); ++r) target_of.push_back(static_cast<std::int32_t>(r));
  const auto differences = protonation_differences(source.molecule, target.molecule, target_of);
  for (const auto& difference : differences) MESSAGE(in_words(difference, source.molecule));
  CHECK(differences.empty());
  CHECK(target.preparation->net_charge > 10);
}

TEST_CASE("prepare_molecule: a name without charges is found before the program runs") {
  const std::string text = lysozyme(1, 20);
  if (text.empty()) return;
  const ScratchFolder folder;
  const std::string program = folder.write("program", "#!/bin/sh\ntouch '" + folder.file("ran") + "'\nexit 1\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  setenv("ESPDIFF_PDB2PQR", program.c_str(), 1);
  setenv("ESPDIFF_OBABEL", "/nowhere/obabel", 1);
  const std::string ligand = "HETATM 9001  C1  LIG A 302      70.000  60.000  60.000  1.00  0.00           C\n";
  CHECK(message_of([&] { prepare(read(folder, text + ligand)); }).find("in.pdb: 1 atom gets no charge") == 0);
  const std::string dna = "ATOM   9001  P    DA B   1      70.000  60.000  60.000  1.00  0.00           P\n";
  ChargeOptions parse = without_cache();
  parse.force_field = "parse";
  CHECK(message_of([&] { prepare_molecule(read(folder, text + dna), parse, {}, Progress()); }) ==
        "in.pdb: 1 atom gets no charge from PDB2PQR's force field parse: DA 1 of chain B (first atom P); take a force "
        "field that has nucleotides (force-field amber), or drop them (leave-out (DA))");
  unsetenv("ESPDIFF_PDB2PQR");
  unsetenv("ESPDIFF_OBABEL");
  CHECK_FALSE(std::filesystem::exists(folder.file("ran")));
}

TEST_CASE(
    "prepare_molecule: an amino acid with atoms that its name does not have is charged as a modified one, or named") {
  const std::string text = lysozyme(1, 30);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  // 4-fluorophenylalanine under the name of phenylalanine.
  Molecule molecule = read(folder, text);
  const auto residue = static_cast<std::size_t>(std::find_if(molecule.residues.begin(), molecule.residues.end(),
                                                             [](const Residue& r) { return r.name == "PHE"; }) -
                                                molecule.residues.begin());
  const std::string label = "PHE " + std::to_string(molecule.residues[residue].number) + " of chain A";
  Vec3d cz{}, cg{};
  for (std::size_t i = 0; i < molecule.size(); ++i) {
    if (static_cast<std::size_t>(molecule.atoms[i].residue) != residue) continue;
    if (molecule.atoms[i].name == "CZ") cz = molecule.positions[i];
    if (molecule.atoms[i].name == "CG") cg = molecule.positions[i];
  }
  constexpr double kBond_A = 1.35;
  Atom fluorine;
  fluorine.name = fluorine.element = "F";
  fluorine.residue = static_cast<std::int32_t>(residue);
  molecule.atoms.push_back(fluorine);
  molecule.positions.push_back(cz + kBond_A / norm(cz - cg) * (cz - cg));
  molecule.radii.push_back(0);
  ChargeOptions files = without_cache();
  files.ligands_auto = false;
  const std::string selection = "//A/" + std::to_string(molecule.residues[residue].number) + "/F";
  CHECK(message_of([&] { prepare_molecule(molecule, files, {}, Progress()); })
            .find("in.pdb: 1 atom gets no charge from PDB2PQR's force field parse: " + label +
                  " (first atom F); let Open Babel make them") == 0);
  CHECK(message_of([&] { prepare_molecule(molecule, files, {}, Progress()); })
            .find("charges for all atoms (topology FILE, charges-from FILE or a PQR), or drop them (leave-out " +
                  selection + ")") != std::string::npos);
  if (find_open_babel().empty()) return;
  const Prepared prepared = prepare(molecule);
  CHECK(prepared.preparation.groups ==
        std::vector<std::string>{label +
                                 ": +0 e, in its chain, by Open Babel (Gasteiger's charges, pH 7), since PHE has "
                                 "no F"});
  CHECK(prepared.preparation.net_charge ==
        doctest::Approx(prepare(read(folder, text)).preparation.net_charge).epsilon(1e-4));
}

TEST_CASE("prepare_molecule: DNA under the names of before 2007 is prepared, thymine's methyl group too") {
  const std::string path = "/usr/share/doc/theseus/examples/1s40.pdb.gz";
  if (!std::filesystem::exists(path) || !has_pdb2pqr()) return;
  const Molecule whole = read_structure(path, {1, true, false, {}});
  std::vector<bool> is_dna;
  for (const auto& atom : whole.atoms)
    is_dna.push_back(whole.residues[static_cast<std::size_t>(atom.residue)].chain == "B");
  const Prepared prepared = prepare(espdiff::keep_atoms(whole, is_dna));
  CHECK(prepared.preparation.net_charge == doctest::Approx(-10).epsilon(1e-3));  // ten phosphates
  CHECK(prepared.preparation.renamed.size() == 11);
  CHECK_FALSE(prepared.preparation.propka);
}

TEST_CASE(
    "prepare_molecule: a protein and DNA under one chain's name are prepared as two molecules, and a note says so") {
  const std::string path = "/usr/share/doc/theseus/examples/1s40.pdb.gz";
  if (!std::filesystem::exists(path) || !has_pdb2pqr()) return;
  const Molecule apart = read_structure(path, {1, true, false, {}});
  Molecule merged = apart;
  std::int32_t number = 99;  // which the protein has, too
  for (Residue& residue : merged.residues) {
    if (residue.chain == "B") residue.number = ++number;
    residue.chain = "A";
  }
  const Prepared two = prepare(apart), one = prepare(merged);
  CHECK(one.molecule.charges == two.molecule.charges);
  CHECK(one.preparation.added == two.preparation.added);
  CHECK(one.preparation.n_hydrogens_added == two.preparation.n_hydrogens_added);
  CHECK(one.preparation.net_charge == doctest::Approx(std::round(one.preparation.net_charge)).epsilon(1e-4));
  REQUIRE(one.preparation.notes.size() == two.preparation.notes.size() + 1);
  CHECK(one.preparation.notes.back() ==
        "chain A has 2 molecules, each with ends of its own; those after the first begin with DG 100 of chain A");
  // A ligand has no molecule of its own, and a chain of one has one.
  CHECK(pieces_of_chains(apart) == std::vector<std::size_t>(apart.residues.size(), 0));
  CHECK(pieces_of_chains(merged).back() == 1);
}

TEST_CASE("pieces_of_chains: nucleotides that are not bound begin anew, also where atoms at the bond are missing") {
  Molecule dna;
  const auto add = [&](int number, double x, const std::string& without) {
    dna.residues.push_back({"DA", "A", number, ' '});
    for (const auto& [name, at] :
         {std::pair<std::string, double>("P", 0), {"O5'", 1.5}, {"C5'", 2}, {"C3'", 3}, {"O3'", 4}}) {
      if (without.find(name) != std::string::npos) continue;
      Atom atom;
      atom.name = name;
      atom.residue = static_cast<std::int32_t>(dna.residues.size() - 1);
      dna.atoms.push_back(atom);
      dna.positions.push_back({x + at, 0, 0});
    }
  };
  add(1, 0, "P");
  add(2, 5.6, "");
  add(3, 11.2, "P O3'");
  add(4, 16.8, "");
  add(14, 40, "O3'");
  add(15, 60, "P O5'");
  CHECK(pieces_of_chains(dna) == std::vector<std::size_t>{0, 0, 0, 0, 1, 2});
}

TEST_CASE("prepare_molecule: two proteins under one chain's name, of which the second begins at a lower number") {
  const std::string text = lysozyme(1, 30);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const Molecule one = read(folder, text);
  Molecule two = one;
  for (const Residue& residue : one.residues) two.residues.push_back(residue);
  for (std::size_t i = 0; i < one.size(); ++i) {
    two.atoms.push_back(one.atoms[i]);
    two.atoms.back().residue += static_cast<std::int32_t>(one.residues.size());
    two.positions.push_back(one.positions[i] + Vec3d{100, 0, 0});
    two.radii.push_back(one.radii[i]);
  }
  const Prepared single = prepare(one), both = prepare(two);
  CHECK(both.preparation.net_charge == doctest::Approx(2 * single.preparation.net_charge).epsilon(1e-4));
  CHECK(both.molecule.size() == 2 * single.molecule.size());
  CHECK(both.molecule.residues.size() == two.residues.size());
  // A gap within a chain is none: its numbers rise.
  CHECK(pieces_of_chains(read(folder, lysozyme(1, 5) + lysozyme(20, 25))) == std::vector<std::size_t>(11, 0));
}

TEST_CASE("force_field_for: AMBER where there are nucleotides, one force field for both states") {
  Molecule protein, dna;
  protein.name = "protein.pdb";
  dna.name = "dna.pdb";
  protein.residues = {{"ALA", "A", 1, ' '}};
  dna.residues = {{"DA", "B", 1, ' '}};
  CHECK(force_field_for(protein, nullptr, "auto") == "parse");
  CHECK(force_field_for(dna, nullptr, "auto") == "amber");
  CHECK(force_field_for(protein, &dna, "auto") == "amber");
  CHECK(force_field_for(dna, &protein, "charmm") == "charmm");
  CHECK(message_of([&] { force_field_for(dna, &protein, "auto"); }) ==
        "dna.pdb: has nucleotides, which get charges of AMBER, and the source has none and charges of PARSE; take one "
        "force field for both (force-field amber)");
}

TEST_CASE("load_state: what is left out is kept aside with its charge, and PROPKA sees it") {
  const std::string text = lysozyme(1, 40);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const std::string groups =
      "HETATM 9000 ZN    ZN A 301      40.000   5.000  10.000  1.00  0.00          ZN\n"
      "HETATM 9001  O   HOH A 302      70.000  60.000  60.000  1.00  0.00           O\n";
  folder.write("in.pdb", text + groups);
  InputOptions options;
  options.charges.use_cache = false;
  options.leave_out = "(ZN)";
  const LoadedState state = load_state(StructureFile(folder.file("in.pdb")), {}, options, Progress());
  REQUIRE(state.molecule.left_out.size() == 1);
  CHECK(state.molecule.left_out[0].residue.name == "ZN");
  CHECK(state.molecule.left_out[0].charge == 2);
  REQUIRE(state.preparation);
  CHECK(state.preparation->notes ==
        std::vector<std::string>{"PROPKA saw 1 group beside the chains that the molecule leaves out"});
  for (const Residue& residue : state.molecule.residues) CHECK(residue.name != "ZN");
}

TEST_CASE("prepare_molecule: PROPKA gets CHARMM's zinc by its usual name") {
  const std::string text = lysozyme(1, 40);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const auto with_zinc = [&](const std::string& name) {
    return prepare(read(
        folder, text + "HETATM 9000 ZN   " + name + " A 301      40.000   5.000  10.000  1.00  0.00          Zn\n"));
  };
  const Prepared usual = with_zinc("ZN "), charmm = with_zinc("ZN2");
  CHECK(charmm.preparation.propka);
  CHECK(charmm.molecule.residues.back().name == "ZN2");
  CHECK(charmm.molecule.charges == usual.molecule.charges);
  CHECK(charmm.preparation.groups == std::vector<std::string>{"ZN2 301 of chain A: +2 e (common oxidation state)"});
}

TEST_CASE("prepare_molecule: a free amino acid under a chain's name, for which PDB2PQR renames the chain") {
  const std::string text = lysozyme(1, 20);
  if (text.empty() || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const std::string free =
      "HETATM 9000  N   GLY A 901      60.000  60.000  60.000  1.00  0.00           N\n"
      "HETATM 9001  CA  GLY A 901      61.458  60.000  60.000  1.00  0.00           C\n"
      "HETATM 9002  C   GLY A 901      62.009  61.420  60.000  1.00  0.00           C\n"
      "HETATM 9003  O   GLY A 901      61.251  62.391  60.000  1.00  0.00           O\n"
      "HETATM 9004  OXT GLY A 901      63.230  61.600  60.000  1.00  0.00           O\n";
  const Prepared alone = prepare(read(folder, text)), both = prepare(read(folder, text + free));
  CHECK(both.molecule.residues.size() == alone.molecule.residues.size() + 1);
  for (const Residue& residue : both.molecule.residues) CHECK(residue.chain == "A");
  CHECK(both.preparation.net_charge == doctest::Approx(alone.preparation.net_charge).epsilon(1e-3));
}
