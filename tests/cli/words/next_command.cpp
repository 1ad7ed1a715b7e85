// next_command.cpp: the command that a stop prints is run, and gives what it promises.
#include <doctest/doctest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>

#include "cli/run_espdiff.h"
#include "cli/words/next_command.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// Behind "next: espdiff " at the beginning of a line; empty without one.
std::string next_words(const std::string& printed) {
  const std::string mark = "next: espdiff ";
  const std::size_t at = ("\n" + printed).find("\n" + mark);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + mark.size();
  return printed.substr(begin, printed.find('\n', begin) - begin);
}

std::string row_of_chain(char chain, double y) {
  std::string text = row_of_atoms(24), out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    std::string line = text.substr(at, end - at);
    line[21] = chain;
    char place[16];
    std::snprintf(place, sizeof place, "%8.3f", std::atof(line.substr(38, 8).c_str()) + y);
    out += line.replace(38, 8, place) + '\n';
    at = end + 1;
  }
  return out;
}

/// Carbons of a residue that nobody knows, in a row, as PDB and as PSF.
std::string unknown_residue(int n, double y) {
  std::string text;
  for (int i = 0; i < n; ++i) {
    char line[160];
    std::snprintf(line, sizeof line, "ATOM  %5d  C%-2d QQQ A   1    %8.3f%8.3f%8.3f  1.00  0.00           C\n", i + 1,
                  i + 1, 1.5 * i, y + 0.7 * (i % 3), 0.4 * (i % 2));
    text += line;
  }
  return text;
}
std::string psf_of_unknown(int n, double charge) {
  std::string text = "PSF\n\n " + std::to_string(n) + " !NATOM\n";
  for (int i = 0; i < n; ++i)
    text += std::to_string(i + 1) + " A 1 QQQ C" + std::to_string(i + 1) + " C " +
            std::to_string(i % 2 == 0 ? charge : -charge) + " 12.011 0\n";
  return text;
}

constexpr const char* kCoarse = " --potential none --grid-spacing 1 --device cpu";

}  // namespace

TEST_CASE("next: a result that exists is replaced by the command that the refusal prints") {
  const ScratchFolder folder;
  folder.write("a b.pqr", row_of_atoms(12));
  folder.write("c.pqr", row_of_atoms(12, 0.25));
  const std::string quoted =
      "compare '" + folder.file("a b.pqr") + "' " + folder.file("c.pqr") + kCoarse + " -q -o " + folder.file("pair");
  REQUIRE(run_espdiff(quoted).status == 0);
  const Outcome refused = run_espdiff(quoted);
  CHECK(refused.status == 2);
  CHECK(contains(refused.err,
                 "pair exists; --overwrite replaces it, another --output keeps it\nnext: espdiff compare '"));
  const Outcome again = run_espdiff(next_words(refused.err));
  CHECK_MESSAGE(again.status == 0, again.err);
}

TEST_CASE("next: charges of PSF files beside structures that nothing else can charge") {
  const ScratchFolder folder;
  const std::string a = folder.write("a.pdb", unknown_residue(12, 0)),
                    b = folder.write("b.pdb", unknown_residue(12, 0.4));
  const std::string first = folder.write("a.psf", psf_of_unknown(12, 0.5)),
                    second = folder.write("b.psf", psf_of_unknown(12, 0.4));
  std::string words = "compare " + a + " " + b + " --grid-spacing 1 --pb-spacing 1 --device cpu -q --ligands files";
  for (const auto& [role, topology] : {std::pair("source", first), std::pair("target", second)}) {
    const Outcome refused = run_espdiff(words);
    CHECK(refused.status == 2);
    const std::string option = std::string("--") + role + "-topology " + topology;
    CHECK_MESSAGE(contains(refused.err, topology + " beside it has charges of its atoms: " + option), refused.err);
    words = next_words(refused.err);
    CHECK_MESSAGE(contains(words, option), words);
  }
  const Outcome compared = run_espdiff(words + " -o " + folder.file("pair"));
  CHECK_MESSAGE((compared.status == 0 || compared.status == 3), compared.err);
  // Another number of atoms is another molecule's.
  folder.write("a.psf", psf_of_unknown(11, 0.5));
  const Outcome without = run_espdiff("compare " + a + " " + b + " --ligands files");
  CHECK(without.status == 2);
  CHECK_FALSE(contains(without.err, "beside it"));
}

TEST_CASE("without -o, a second run gets a name of its own") {
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(12));
  folder.write("b.pqr", row_of_atoms(12, 0.25));
  const std::string in_folder = "cd " + folder.file("") + " &&";
  for (int i = 0; i < 2; ++i) REQUIRE(run_espdiff("a.pqr b.pqr -q" + std::string(kCoarse), in_folder).status == 0);
  CHECK_FALSE(read_file(folder.file("a_b.json")).empty());
  CHECK_FALSE(read_file(folder.file("a_b_2.json")).empty());
  CHECK(folder.n_files() == 8);
}

TEST_CASE("next: a chain more in one state is left out by the command that was tried, which is trusted") {
  const ScratchFolder folder;
  const std::string answered = "compare " + folder.write("two.pqr", row_of_chain('A', 0) + row_of_chain('B', 40)) +
                               " " + folder.write("one.pqr", row_of_chain('A', 0)) + kCoarse + " --overwrite -o " +
                               folder.file("out"),
                    run = answered + " --require 0.95";
  const Outcome half = run_espdiff(answered);  // on half of the surface
  CHECK(half.status == 0);
  CHECK_MESSAGE(contains(half.out, "TRUSTWORTHY ON "), half.out);
  const Outcome outcome = run_espdiff(run);
  CHECK(outcome.status == 3);
  CHECK(contains(outcome.out, "tried, chain A alone: TRUSTWORTHY"));
  const Outcome next = run_espdiff(next_words(outcome.out));
  CHECK_MESSAGE(next.status == 0, next.err);
  CHECK(run_espdiff(run + " --overwrite --exit-zero -q").status == 0);
  const Outcome no_trials = run_espdiff(run + " --overwrite --no-trials");
  CHECK(no_trials.status == 3);
  CHECK(next_words(no_trials.out) == "render " + folder.file("out") + " -o " + folder.file("out.png"));
  CHECK(run_espdiff("render --help").status == 0);
  if (std::getenv("DISPLAY") == nullptr) return;
  // The picture is there already: the next one shows why.
  const Outcome drawn = run_espdiff(answered + ".png --require 0.95 --no-trials");
  CHECK(drawn.status == 3);
  const std::string why = next_words(drawn.out);
  CHECK(why == "render " + folder.file("out") + " --color why -o " + folder.file("out.why.png"));
  CHECK(run_espdiff(why).status == 0);
}

TEST_CASE("next: ligands of both files are named at once, and made by the command of the error") {
  const auto source = real_input("pairs/1ake.pdb"), target = real_input("pairs/4ake.pdb");
  if (!source || !has_pdb2pqr()) return;
  const ScratchFolder folder;
  std::string with_ligand = read_file(*target);
  const std::string group =
      "HETATM 9990  C1  LIG A 901      60.000  60.000  60.000  1.00  0.00           C\n"
      "HETATM 9991  C2  LIG A 901      61.520  60.000  60.000  1.00  0.00           C\n";
  with_ligand.insert(with_ligand.find("\nHETATM") + 1, group);
  const std::string run = "compare " + *source + " " + folder.write("t.pdb", with_ligand) +
                          " --select //A --grid-spacing 2 --pb-spacing 1.5 --device cpu -q --exit-zero --ligands files "
                          "-o " +
                          folder.file("out");
  const Outcome refused = run_espdiff(run);
  CHECK(refused.status == 2);
  CHECK(contains(refused.err, "AP5 215 of chain A"));
  CHECK(contains(refused.err, "LIG 901 of chain A"));
  CHECK(contains(refused.err, "--leave-out '(AP5,LIG)'"));
  if (next_words(refused.err).empty()) {
    CHECK(contains(refused.err, "\nnext: apt install openbabel && espdiff compare "));
    return;
  }
  CHECK(contains(next_words(refused.err), " --ligands auto"));
  const Outcome next = run_espdiff(next_words(refused.err));
  CHECK_MESSAGE(next.status == 0, next.err);
  CHECK(contains(next.err, "of the source, the net charge of a ligand is a guess by Open Babel's rules"));
  CHECK(contains(read_file(folder.file("out.json")), "AP5 215 of chain A: -"));
}

TEST_CASE("next: what is left out is added to what was typed, or no command is given") {
  using espdiff::NextCommand;
  const NextCommand next{"", {{"leave-out", "(IRI)"}}};
  CHECK(espdiff::cli::next_command({"prepare", "a.pdb"}, next) == "espdiff prepare a.pdb --leave-out '(IRI)'");
  CHECK(espdiff::cli::next_command({"--leave-out", "(B1Z,CL)", "prepare", "a.pdb"}, next) ==
        "espdiff prepare a.pdb --leave-out '(B1Z,CL,IRI)'");
  CHECK(espdiff::cli::next_command({"prepare", "a.pdb", "--leave-out=(B1Z)"}, next) ==
        "espdiff prepare a.pdb --leave-out '(B1Z,IRI)'");
  for (const char* const other : {"//A", "(!HOH)", "//A;(B1Z)", "()"})
    CHECK(espdiff::cli::next_command({"prepare", "a.pdb", "--leave-out", other}, next).empty());
}

TEST_CASE("next: a trajectory that only VMD's readers read is handed to Python, DCD is read") {
  const ScratchFolder folder;
  const std::string run = "trajectory " + folder.write("a.pqr", row_of_atoms(12)) + " " +
                          folder.write("a.xtc", "no trajectory") + " --potential none -q -o " + folder.file("t.csv");
  const Outcome refused = run_espdiff(run, "PATH=/usr/bin:/bin VMDDIR=");
  CHECK(refused.status != 0);
  if (contains(refused.err, "none were found"))
    CHECK(contains(refused.err, "\nnext: python3 -m espdiff trajectory " + folder.file("a.pqr")));
}

TEST_CASE("trajectory: PSF and DCD without VMD, and the plot with the table where its output is named OUT.png") {
  const auto psf = real_input("traj_adk/adk.psf"), dcd = real_input("traj_adk/adk_dims.dcd");
  if (!psf || !dcd) return;
  const ScratchFolder folder;
  const Outcome outcome = run_espdiff("trajectory " + *psf + " " + *dcd + " --frames 0:40:60 --potential none" +
                                          " --grid-spacing 2 --device cpu -o " + folder.file("t.png"),
                                      "PATH=/usr/bin:/bin VMDDIR=");
  if (contains(outcome.err, "gnuplot, which is not installed")) return;
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "written        " + folder.file("t.csv") + ", " + folder.file("t.png")));
  CHECK(n_lines(read_file(folder.file("t.csv"))) > 2);
  CHECK(read_file(folder.file("t.png")).substr(1, 3) == "PNG");
  const Outcome again = run_espdiff("trajectory " + *psf + " " + *dcd + " -o " + folder.file("t.png"), "VMDDIR=");
  CHECK(again.status != 0);
  CHECK(contains(again.err, "overwrite"));
}

namespace {

/// A file that PDB2PQR cannot prepare: the alpha carbons of a protein; empty where it is not there.
std::string trace_of_lysozyme() {
  const auto path = real_input("t4l/3lzm_from_bcif.pdb");
  if (!path || !has_pdb2pqr()) return {};
  std::string trace;
  std::istringstream lines(read_file(*path));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("ATOM", 0) == 0 && line.substr(12, 4) == " CA ") trace += line + "\n";
  }
  return trace;
}

}  // namespace

TEST_CASE("next: what PDB2PQR cannot prepare is compared by its shapes, without the options that need a potential") {
  const ScratchFolder folder;
  const std::string trace = trace_of_lysozyme();
  if (trace.empty()) return;
  const std::string file = folder.write("trace.pdb", trace), pair = file + " " + file;
  const std::string potentials =
      " --pb-spacing=1 --distance-dependent --ionic-strength 0.1 --field normal-field --field e=field-strength"
      " --field q=charge --patches-of potential --patches-of 'q>0.05'";
  const std::string causes = " --causes whole --causes 'residue A:5' --scan --side-chains 3";
  const std::string shapes = " --field curvature --patches-of 'curvature>0.2' --grid-spacing 2 --device cpu -q";
  struct Run {
    std::string typed, output, kept;
  };
  for (const Run& run :
       {Run{"compare " + pair + potentials + causes + " --residue-quantity q_mean_source --residue-pdb " +
                folder.file("r.pdb") + shapes + " -o " + folder.file("out"),
            "out.json", " --patches-of 'curvature>0.2'"},
        Run{"trajectory " + pair + " --pb-spacing 1 --field normal-field --field curvature --residues " +
                folder.file("t.residues.csv") + " --residue-quantity mean_source --device cpu -q -o " +
                folder.file("t.csv"),
            "t.csv", ""},
        Run{"matrix " + file + " " + folder.write("other.pdb", trace) +
                " --pb-spacing 1 --field q=charge --field curvature --cluster-by mean_abs_difference --device cpu -q"
                " -o " +
                folder.file("m"),
            "m.json", ""}}) {
    const Outcome refused = run_espdiff(run.typed);
    CHECK(refused.status == 2);
    CHECK_MESSAGE(contains(refused.err, "PDB2PQR cannot prepare it"), refused.err);
    const std::string words = next_words(refused.err);
    CHECK_MESSAGE(contains(words, " --field curvature" + run.kept), words);
    REQUIRE_MESSAGE(contains(words, " --potential none"), words);
    const Outcome next = run_espdiff(words);
    // A trace has no residues whose potentials could vouch for it.
    CHECK_MESSAGE((next.status == 0 || next.status == 3), words << '\n' << next.err);
    CHECK_FALSE(read_file(folder.file(run.output)).empty());
  }
}

TEST_CASE("next: where a potential is what was asked for, no command gives it up") {
  const ScratchFolder folder;
  const std::string trace = trace_of_lysozyme();
  if (trace.empty()) return;
  const std::string models = "MODEL        1\n" + trace + "ENDMDL\nMODEL        2\n" + trace + "ENDMDL\nEND\n",
                    file = folder.write("trace.pdb", models), other = folder.write("other.pdb", models + "REMARK\n");
  for (const std::string& typed :
       {"potential " + file + " -o " + folder.file("p.dx"), "prepare " + file + " -o " + folder.file("p.pqr"),
        "complementarity " + file + " --interface A:B -o " + folder.file("c"),
        "ensemble --group a " + file + " --group b " + other + " -o " + folder.file("e")}) {
    const Outcome refused = run_espdiff(typed);
    CHECK(refused.status == 2);
    CHECK_MESSAGE(contains(refused.err, "PDB2PQR cannot prepare it"), typed << '\n' << refused.err);
    CHECK_MESSAGE(next_words(refused.err).empty(), refused.err);
  }
}

TEST_CASE("next: source and target exchanged takes their options along, as it was tried") {
  using espdiff::cli::exchanged;
  using espdiff::cli::TypedWords;
  CHECK(exchanged({"a.pdb", "b.pdb", "--target-model", "3", "-q"}, "a.pdb", "b.pdb") ==
        TypedWords{"b.pdb", "a.pdb", "--source-model", "3", "-q"});
  CHECK(exchanged({"a.pdb", "a.pdb", "--target-model=3"}, "a.pdb", "a.pdb") ==
        TypedWords{"a.pdb", "a.pdb", "--source-model=3"});
}

TEST_CASE("compare -o OUT.png draws the picture with the answer, or says before the work why it cannot") {
  const ScratchFolder folder;
  const std::string run = folder.write("a.pqr", row_of_atoms(12)) + " " +
                          folder.write("b.pqr", row_of_atoms(12, 0.25)) + kCoarse + " -q --exit-zero -o " +
                          folder.file("pair.png");
  const Outcome outcome = run_espdiff(run);
  const bool has_picture = read_file(folder.file("pair.png")).rfind("\x89PNG", 0) == 0;
  const bool has_result = !read_file(folder.file("pair.json")).empty();
  CHECK(has_picture == (outcome.status == 0));
  CHECK(has_result == (outcome.status == 0));
  if (outcome.status != 0) {
    CHECK(contains(outcome.err, "pair.png: "));
    return;
  }
  CHECK(contains(run_espdiff(run).err, "pair exists; --overwrite replaces it"));
  CHECK(run_espdiff(run + " --overwrite").status == 0);
}

TEST_CASE("next: potential and prepare keep files that are there, and replace them by the command of the refusal") {
  const ScratchFolder folder;
  const std::string pqr = folder.write("a.pqr", row_of_atoms(12));
  for (const std::string& run : {"potential " + pqr + " --device cpu -q -o " + folder.file("a.dx"),
                                 "prepare " + pqr + " -q -o " + folder.file("b.pqr")}) {
    const Outcome first = run_espdiff(run);
    REQUIRE_MESSAGE(first.status == 0, first.err);
    const Outcome refused = run_espdiff(run);
    CHECK(refused.status == 2);
    CHECK_MESSAGE(contains(refused.err, " exists; --overwrite replaces it, another name keeps it\nnext: espdiff "),
                  refused.err);
    const Outcome next = run_espdiff(next_words(refused.err));
    CHECK_MESSAGE(next.status == 0, next.err);
  }
  CHECK(run_espdiff("prepare " + pqr + " -q -o /dev/null --json /dev/null").err.find("exists") == std::string::npos);
}

TEST_CASE("next: without a potential, what needs one is left out too") {
  const ScratchFolder folder;
  // Residues that are no ligands, that nothing has charges for, and whose place among other options is kept.
  folder.write("x.pdb",
               "HETATM    1  C1  XQZ A   1       0.000   0.000   0.000  1.00  0.00           C\n"
               "HETATM    2  C2  XQZ A   1       1.500   0.000   0.000  1.00  0.00           C\n"
               "HETATM    3  O1  XQZ A   2       2.000   1.200   0.000  1.00  0.00           O\n");
  const std::string in_folder = "cd " + folder.file("") + " &&";
  const Outcome refused = run_espdiff(
      "compare x.pdb x.pdb --patches-of 'potential>1' --field s=field-strength --field h=curvature --causes whole "
      "--field=normal-field --exit-zero --device cpu -o x",
      in_folder);
  CHECK(refused.status == 2);
  CHECK_MESSAGE(next_words(refused.err) ==
                    "compare x.pdb x.pdb --field h=curvature --exit-zero --device cpu -o x --potential none",
                refused.err);
  const Outcome next = run_espdiff(next_words(refused.err), in_folder);
  CHECK_MESSAGE(next.status == 0, next.err);
}
