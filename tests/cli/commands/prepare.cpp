// `espdiff prepare` and comparisons of PDB entries: every file of the folders bad_*, selections, regions, errors.
#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/run_espdiff.h"
#include "io/files/run_program.h"

using espdiff_test::contains;
using espdiff_test::has_pdb2pqr;
using espdiff_test::n_lines;
using espdiff_test::Outcome;
using espdiff_test::read_file;
using espdiff_test::real_input;
using espdiff_test::run_espdiff;
using espdiff_test::ScratchFolder;

namespace {

nlohmann::json json_of(const std::string& path) { return nlohmann::json::parse(read_file(path)); }

}  // namespace

TEST_CASE("prepare: untidy files give an answer or one line that names file, place and remedy") {
  const auto data = real_input("");
  if (!data || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const auto prepared = [&](const std::string& file) {
    return run_espdiff("prepare " + *data + file + " --no-cache --overwrite -o " + folder.file("out.pqr"));
  };
  const std::string cannot = " has no charges, and no amino acids or nucleotides that PDB2PQR could charge, only ",
                    remedy = "; give a PQR, or charges (--topology FILE or --charges-from FILE)\n";
  // What each file is answered: a net charge, or all that follows its name in the error.
  const std::map<std::string, std::string> answers = {
      {"bad_parmed/2igd.pdb", "net charge      -2.0000 e"},
      {"bad_biopython/a_structure.pdb",
       ":20: an atom outside of MODEL ... ENDMDL ('ATOM     22  C   CYS A   0'), in a file that has MODEL records; "
       "move "
       "it into a model, or delete the MODEL and ENDMDL lines\n"},
      {"bad_pdb/insertion-code.pdb", ":1:" + cannot + "XXX 1a of chain X" + remedy},
      {"bad_pdb/odd-start.pdb", "beside chains   EST 600 of chain A: +0 e, 24 hydrogens added, by Open Babel"},
      {"bad_pdb/short-atom.pdb", ":1:" + cannot + "an unnamed residue 1 of chain X" + remedy}};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*data)) {
    const std::string file = entry.path().lexically_relative(*data).string();
    if (!entry.is_regular_file() || file.rfind("bad_", 0) != 0) continue;
    const auto answer = answers.find(file);
    REQUIRE_MESSAGE(answer != answers.end(), "no answer is expected of " << file);
    CAPTURE(file);
    const Outcome outcome = prepared(file);
    const bool is_ligand = file == "bad_pdb/odd-start.pdb";
    if (is_ligand && espdiff::find_program("obabel").empty()) continue;
    if (outcome.status == 0) {
      CHECK(contains(outcome.out, answer->second));
      CHECK(json_of(folder.file("out.json"))["preparation"]["n_atoms"] == (is_ligand ? 44 : 927));
      continue;
    }
    CHECK(outcome.status == 2);
    CHECK(outcome.err == "espdiff: " + entry.path().string() + answer->second);
    CHECK(outcome.out.empty());
  }
  CHECK(folder.n_files() == 2);
}

TEST_CASE("prepare: an atom without charge, an unknown chain, a word that drops nothing, a wrong ligand") {
  const auto path = real_input("pairs/1ake.pdb");
  if (!path || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const auto refused = [&](const std::string& options) {
    const Outcome outcome = run_espdiff("prepare " + *path + " -o " + folder.file("out.pqr") + " " + options);
    CHECK(outcome.status == 2);
    CHECK(n_lines(outcome.err) == (contains(outcome.err, "\nnext: ") ? 2 : 1));
    return outcome.err;
  };
  const std::string uncharged = refused("--select //A --ligands files");
  CHECK(contains(uncharged,
                 "1ake.pdb:3796: 57 atoms get no charges from PDB2PQR's force field parse: AP5 215 of chain A"));
  CHECK(contains(uncharged, "or drop them (--leave-out '(AP5)')"));
  CHECK(
      contains(refused("--select //C"), "--select '//C' selects no atom; the file has chain A (1-214, AP5), chain B"));
  CHECK(contains(refused("--select '//A;polymer' --leave-out '(HEM)'"), "drops no atom"));
  CHECK(contains(refused("--select '//A;polymer' --ligand " + *path), "a ligand is read from a Tripos MOL2 file"));
  const std::string ligand = folder.write("benzene.mol2",
                                          "@<TRIPOS>MOLECULE\nBNZ\n2 1\n@<TRIPOS>ATOM\n1 CX1 0 0 0 C.ar\n2 CX2 1.4 0 0 "
                                          "C.ar\n@<TRIPOS>BOND\n1 1 2 ar\n");
  CHECK(contains(refused("--select '//A;polymer' --ligand " + ligand),
                 "benzene.mol2: no residue that is prepared has heavy atoms of its names; "));
  std::filesystem::remove(ligand);
  CHECK(contains(refused("--assembly 7"), "there is no assembly '7'"));
  CHECK(folder.n_files() == 0);
}

TEST_CASE("compare: two PDB entries to the answer, with a region around a ligand that is not compared") {
  const auto source = real_input("pairs/1ake.pdb"), target = real_input("pairs/4ake.pdb");
  if (!source || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  const Outcome outcome = run_espdiff("compare " + *source + " " + *target +
                                      " --select '//A;polymer' --region-within 5 --of '//A/(AP5)' --grid-spacing 2 "
                                      "--pb-spacing 1.5 --exit-zero --no-trials -o " +
                                      folder.file("adk"));
  CHECK(outcome.status == 0);
  CHECK(outcome.err.empty());
  CHECK(contains(outcome.out, "1ake.pdb; PDB2PQR v3"));
  CHECK(contains(outcome.out, "\nRegion  "));
  const nlohmann::json json = json_of(folder.file("adk.json"));
  CHECK(json["rmsd_A"].get<double>() == doctest::Approx(7.229).epsilon(1e-3));
  CHECK(json["preparation"]["source"]["n_hydrogens_added"] == 1686);
  CHECK(json["chains"]["compared"][0]["n_residues"] == 214);
  CHECK(json["potential"]["label"] == "Poisson-Boltzmann, 0.15 mol/l");
  const std::size_t n_region = json["region"]["n_residues"];
  CHECK(n_region > 20);
  CHECK(n_region < 80);
  CHECK(json["region"]["area_A2"]["trusted"].get<double>() < json["area_A2"]["trusted"].get<double>());
  CHECK(contains(read_file(folder.file("adk.residues.csv")), ",region"));
  CHECK(json["inputs"][0]["path"] == "adk.source.pqr");
  // The kept structures repeat the comparison.
  const Outcome again = run_espdiff("compare " + folder.file("adk.source.pqr") + " " + folder.file("adk.target.pqr") +
                                    " --grid-spacing 2 --pb-spacing 1.5 -q --exit-zero -o " + folder.file("again"));
  CHECK(again.status == 0);
  CHECK(json_of(folder.file("again.json"))["mean_abs_difference"] == json["mean_abs_difference"]);
}

TEST_CASE("compare: copies are said, and swapped chains of a dimer are not compared crosswise") {
  const auto tim = real_input("tim/2YPI.pdb");
  if (!tim) return;
  const ScratchFolder folder;
  // The same dimer with its chains renamed and written in the other order.
  std::string first, second;
  std::istringstream lines(read_file(*tim));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) != 0) continue;
    const bool is_a = line[21] == 'A';
    line[21] = is_a ? 'B' : 'A';
    (is_a ? second : first) += line + "\n";
  }
  const std::string swapped = folder.write("swapped.pdb", first + second);
  const Outcome outcome = run_espdiff(
      "compare " + *tim + " " + swapped +
      " --select ';polymer' --potential none --grid-spacing 2 --exit-zero --no-trials -o " + folder.file("out"));
  CHECK(outcome.status == 0);
  CHECK(contains(outcome.out, "\nCopies, source   chains A, B repeat one sequence"));
  const nlohmann::json json = json_of(folder.file("out.json"));
  CHECK(json["chains"]["copies"]["target"][0] == nlohmann::json{"A", "B"});
  MESSAGE("RMSD ", json["rmsd_A"].get<double>());
}

TEST_CASE("compare: without PDB2PQR shapes alone are compared, and why is said") {
  const auto source = real_input("t4l/3lzm_from_bcif.pdb");
  if (!source) return;
  const ScratchFolder folder;
  const std::string call = "compare " + *source + " " + *source +
                           " --grid-spacing 2 --exit-zero --no-trials --overwrite -o " + folder.file("out");
  const Outcome outcome = run_espdiff(call, "ESPDIFF_PDB2PQR=/no/such/program");
  CHECK(outcome.status == 0);
  CHECK(contains(outcome.out, "has no charges"));
  CHECK(contains(run_espdiff("show " + folder.file("out")).out,
                 "has no charges, and PDB2PQR, which assigns some, is not there; install it"));
  const Outcome asked = run_espdiff(call + " --potential pb", "ESPDIFF_PDB2PQR=/no/such/program");
  CHECK(asked.status == 1);
  CHECK(contains(asked.err, "PDB2PQR, which assigns them, is not there"));
}
