// trajectory.cpp: `espdiff trajectory`: frames of files, values taken from the source, computed potentials, resuming.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

constexpr int kAtoms = 12;

struct Vec {
  double x, y, z;
};

Vec place(int atom, double bend) {
  const double x = 2.5 * atom;
  return {x, 1.1 * (atom % 3), 0.5 * (atom % 2) + bend * 0.01 * x * x};
}

std::string pqr(double bend = 0, int n_atoms = kAtoms) {
  std::string text;
  for (int i = 0; i < n_atoms; ++i) {
    char line[128];
    const Vec p = place(i, bend);
    std::snprintf(line, sizeof line, "ATOM %d CA ALA A %d %.3f %.3f %.3f %.4f 2.2\n", i + 1, i + 1, p.x, p.y, p.z,
                  i % 3 == 0 ? -0.7 : 0.4);
    text += line;
  }
  return text;
}

/// Models that bend farther and farther, as PDB: without charges.
std::string pdb_models(int first, int n, int n_atoms = kAtoms, const char* cell = "") {
  std::string text = cell;
  for (int model = first; model < first + n; ++model) {
    text += "MODEL     " + std::to_string(model + 1) + "\n";
    for (int i = 0; i < n_atoms; ++i) {
      char line[128];
      const Vec p = place(i, 0.5 * model);
      std::snprintf(line, sizeof line, "ATOM  %5d  CA  ALA A%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n", i + 1,
                    i + 1, p.x, p.y, p.z);
      text += line;
    }
    text += "ENDMDL\n";
  }
  return text;
}

constexpr const char* kCell = "CRYST1   60.000   40.000   40.000  90.00  90.00  90.00 P 1           1\n";

/// One column of the file.
std::vector<std::string> column(const std::string& path, const std::string& name) {
  std::vector<std::string> values;
  std::istringstream in(read_file(path));
  std::size_t index = std::string::npos;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("# ", 0) == 0) continue;
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    if (index == std::string::npos) {
      index = static_cast<std::size_t>(std::find(cells.begin(), cells.end(), name) - cells.begin());
      continue;
    }
    values.push_back(cells.at(index));
  }
  return values;
}

}  // namespace

#ifdef ESPDIFF_HAVE_GEMMI

TEST_CASE("trajectory: frames of several files, charges and radii from the source, potentials by PME") {
  const ScratchFolder folder;
  const std::string source = folder.write("a.pqr", pqr()), one = folder.write("one.pdb", pdb_models(0, 2)),
                    two = folder.write("two.pdb", pdb_models(2, 3));
  const std::string start = "trajectory " + source + " " + one + " " + two + " --device cpu --method deform ";
  const Outcome outcome = run_espdiff(start + "--potential pme -o " + folder.file("a.csv"));
  if (outcome.status == 1 && contains(outcome.err, "has no pocketfft")) {
    MESSAGE("SKIPPED: ", outcome.err);
    return;
  }
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "5 written, 0 were there"));
  const auto trusted = column(folder.file("a.csv"), "trustworthy");
  CHECK(contains(outcome.out,
                 std::to_string(std::count(trusted.begin(), trusted.end(), "1")) + " of 5 rows; column reasons"));
  CHECK(column(folder.file("a.csv"), "frame") == std::vector<std::string>{"0", "1", "2", "3", "4"});
  CHECK(column(folder.file("a.csv"), "potential_unit")[4] == "kT/e in vacuum");
  // The first frame is the source itself: the same radii and charges, hence nothing differs but rounding to 0.001 A.
  const auto differences = column(folder.file("a.csv"), "mean_abs_difference");
  CHECK(std::stod(differences[0]) < 0.05);
  CHECK(std::stod(differences[4]) > 10 * std::stod(differences[0]));
  CHECK(column(folder.file("a.csv"), "start")[3] == "previous");
  // The same frames as PQR, one file each: the same rows.
  std::string files;
  for (int i = 0; i < 5; ++i) files += folder.write("f" + std::to_string(i) + ".pqr", pqr(0.5 * i)) + " ";
  CHECK(run_espdiff("trajectory " + source + " " + files + "--device cpu --method deform --potential pme -q -o " +
                    folder.file("b"))
            .status == 0);
  CHECK(run_espdiff("report " + folder.file("b")).status == 0);
  for (const char* name : {"rmsd_A", "mean_abs_difference", "iterations"})
    CHECK(column(folder.file("a.csv"), name) == column(folder.file("b.csv"), name));
  // In the file's own cell another potential.
  const std::string with_cell = folder.write("cell.pqr", kCell + pqr()),
                    frames = folder.write("cell.pdb", pdb_models(0, 5, kAtoms, kCell));
  CHECK(run_espdiff("trajectory " + with_cell + " " + frames +
                    " --device cpu --method deform --potential pme --pme-cell own --frames 0:4:end -q -o " +
                    folder.file("c.csv"))
            .status == 0);
  CHECK(column(folder.file("c.csv"), "frame") == std::vector<std::string>{"0", "4"});
  CHECK(column(folder.file("c.csv"), "mean_abs_difference")[1] != differences[4]);
  const Outcome no_cell = run_espdiff(start + "--potential pme --pme-cell own -o " + folder.file("d.csv"));
  CHECK(no_cell.status == 2);
  CHECK(contains(no_cell.err, "there is no cell (a CRYST1 record"));
}

TEST_CASE("trajectory: maps of files, resuming, replacing") {
  const ScratchFolder folder;
  const std::string source = folder.write("a.pqr", pqr()), frames = folder.write("f.pdb", pdb_models(0, 4)),
                    low = folder.write("low.dx", constant_dx(33, 4.0, 1.0)),
                    high = folder.write("high.dx", constant_dx(33, 4.0, 4.0)), csv = folder.file("a.csv");
  const std::string start = "trajectory " + source + " " + frames + " --device cpu --method deform --source-map " +
                            low + " --target-map " + high + " -o " + csv + " ";
  CHECK(run_espdiff(start).status == 0);
  for (const std::string& value : column(csv, "mean_signed_difference")) CHECK(std::stod(value) == doctest::Approx(3));
  const auto rmsd = column(csv, "rmsd_A"), iterations = column(csv, "iterations");
  // The last two rows are missing, the next is incomplete, and the mapping is gone.
  const std::string whole = read_file(csv);
  std::size_t end = whole.size();
  for (int i = 0; i < 3; ++i) end = whole.rfind('\n', end - 1);
  folder.write("a.csv", whole.substr(0, end + 1) + "2,file");
  const Outcome exists = run_espdiff(start);
  CHECK(exists.status == 2);
  CHECK(contains(exists.err, "--resume continues it, --overwrite replaces it"));
  CHECK(contains(run_espdiff(start + "--resume --mu 0.6").err,
                 "was made with settings 'method deform', not with 'method deform mu 0.6'"));
  const Outcome resumed = run_espdiff(start + "--resume");
  CHECK_MESSAGE(resumed.status == 0, resumed.err);
  CHECK(contains(resumed.out, "2 written, 2 were there"));
  CHECK(contains(resumed.err, "the mapping of frame 1 is missing, the next one starts from the source"));
  CHECK(column(csv, "rmsd_A") == rmsd);
  CHECK(run_espdiff(start + "--overwrite --start source -q --frames last").out.empty());
  CHECK(column(csv, "frame") == std::vector<std::string>{"3"});
  CHECK(folder.n_files() == 5);
}

namespace {

/// A run of its own, which continues while the test looks at its file.
pid_t start_run(const std::string& arguments) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  const std::string command = "exec " ESPDIFF_BINARY " trajectory " + arguments + " >/dev/null 2>&1 </dev/null";
  ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
  ::_exit(127);
}

/// Waits until the file has a row, or the run has ended.
bool gets_row(const std::string& csv, pid_t run) {
  while (::waitpid(run, nullptr, WNOHANG) == 0) {
    std::error_code ignored;
    if (std::filesystem::exists(csv, ignored) && contains(read_file(csv), "\n0,")) return true;
    ::usleep(2000);
  }
  return false;
}

}  // namespace

TEST_CASE("trajectory: two processes on one file; a killed run continues to the same bytes and leaves nothing") {
  const ScratchFolder folder;
  const std::string source = folder.write("a.pqr", pqr()), frames = folder.write("f.pdb", pdb_models(0, 6)),
                    csv = folder.file("a.csv"), whole = folder.file("whole.csv");
  const std::string start = source + " " + frames + " --device cpu --start previous --grid-spacing 0.5 -q -o ";
  CHECK(run_espdiff("trajectory " + start + whole).status == 0);
  const pid_t first = start_run(start + csv);
  REQUIRE(gets_row(csv, first));
  ::kill(first, SIGSTOP);
  for (const char* how : {"", " --resume", " --overwrite"}) {
    const Outcome second = run_espdiff("trajectory " + start + csv + how);
    CHECK(second.status == 2);
    CHECK(n_lines(second.err) == 1);
    if (*how != '\0') CHECK(contains(second.err, csv + ": another run is writing this file; wait for its end"));
  }
  ::kill(first, SIGKILL);
  ::waitpid(first, nullptr, 0);
  folder.write("a.csv.state.tmp4711-0", "what the killed run was writing");
  CHECK(run_espdiff("trajectory " + start + csv + " --resume").status == 0);
  CHECK(read_file(csv) == read_file(whole));
  CHECK(folder.n_files() == 4);
}

TEST_CASE("trajectory: wrong input gives one line and leaves nothing") {
  const ScratchFolder folder;
  const std::string source = folder.write("a.pqr", pqr()), frames = folder.write("f.pdb", pdb_models(0, 2)),
                    fewer = folder.write("g.pdb", pdb_models(0, 2, kAtoms - 1)),
                    bare = folder.write("b.pdb", pdb_models(0, 1)), map = folder.write("m.dx", constant_dx(9, 9.0, 1));
  const std::size_t n_before = folder.n_files();
  struct Case {
    std::string arguments;
    const char* expected;
  };
  for (const Case& c :
       {Case{source + " " + frames + " --frames 2", "--frames '2': frame 2 is not among the frames 0 to 1"},
        {source + " " + fewer + " --potential pme", "it lacks CA of ALA A 12 (11 and 12 atoms)"},
        {source + " " + fewer, "frame 0: "},
        {bare + " " + frames + " --potential pme",
         "has no charges, and PDB2PQR cannot prepare it: it has C-alpha atoms only"},
        {source + " " + frames + " --potential pme --target-map " + map, "--potential computes both maps"},
        {source + " " + frames + " --source-map " + map, "was given for the source only"},
        {source + " " + frames + " --resume --overwrite", "exclude each other"},
        {source + " " + folder.file("absent.pdb"), "absent.pdb"},
        {source + " " + map, "that is no structure"},
        {source + " " + frames + " --source-model 2", "model 2"},
        {source + " " + frames + " --mu 3", "mu"}}) {
    const Outcome outcome = run_espdiff("trajectory " + c.arguments + " --device cpu -o " + folder.file("a.csv"));
    CAPTURE(c.arguments);
    if (contains(outcome.err, "has no pocketfft")) continue;
    CHECK_MESSAGE(outcome.status == 2, outcome.err);
    CHECK_MESSAGE(contains(outcome.err, c.expected), outcome.err);
    CHECK(outcome.out.empty());
    CHECK(folder.n_files() == n_before);
  }
  CHECK(run_espdiff("trajectory " + source + " " + frames).status == 2);
  CHECK(
      contains(run_espdiff("trajectory " + source + " " + frames + " -o " + folder.file("no/a.csv")).err, "no/a.csv"));
  CHECK(folder.n_files() == n_before);
}

TEST_CASE("trajectory against trajectory: frame i of one molecule against frame i of another") {
  const ScratchFolder folder;
  // The mutant lacks the last atom; its frames have no charges.
  const std::string wild = folder.write("wild.pqr", pqr()), frames = folder.write("wild.pdb", pdb_models(0, 3)),
                    mutant = folder.write("mutant.pqr", pqr(0, kAtoms - 1)),
                    others = folder.write("mutant.pdb", pdb_models(1, 3, kAtoms - 1));
  const std::string call = "trajectory " + wild + " " + others + " --source-frames " + frames + " --frames-of " +
                           mutant + " --potential coulomb -o " + folder.file("a.csv") + " --residues " +
                           folder.file("r.csv");
  const Outcome run = run_espdiff(call);
  REQUIRE_MESSAGE(run.status == 0, run.err);
  CHECK(column(folder.file("a.csv"), "frame") == std::vector<std::string>{"0", "1", "2"});
  CHECK(column(folder.file("a.csv"), "reference_frame") == std::vector<std::string>{"0", "1", "2"});
  // Each row is the pair's own.
  const std::string source = folder.write("s.pqr", pqr(0.5)), target = folder.write("t.pqr", pqr(1.0, kAtoms - 1));
  REQUIRE(
      run_espdiff("compare " + source + " " + target + " --potential coulomb -q -o " + folder.file("pair")).status ==
      0);
  const auto pair = nlohmann::json::parse(read_file(folder.file("pair.json")));
  CHECK(std::stod(column(folder.file("a.csv"), "rmsd_A")[1]) ==
        doctest::Approx(pair["rmsd_A"].get<double>()).epsilon(1e-3));
  CHECK(std::stod(column(folder.file("a.csv"), "mean_abs_difference")[1]) ==
        doctest::Approx(pair["mean_abs_difference"].get<double>()).epsilon(0.02));
  CHECK(column(folder.file("r.csv"), "frame") == std::vector<std::string>{"0", "1", "2"});
  CHECK_FALSE(column(folder.file("r.csv"), "A:ALA 1")[2].empty());
  CHECK(run_espdiff(call).err.find(": the file exists; --resume continues it") != std::string::npos);
  CHECK(run_espdiff(call + " --resume").status == 0);

  const std::string four = folder.write("four.pdb", pdb_models(0, 4));
  CHECK(run_espdiff("trajectory " + wild + " " + frames + " --source-frames " + four + " -o " + folder.file("b.csv"))
            .err == "espdiff: the trajectories have 4 and 3 frames; choose those of both: --frames 0:2\n");
  CHECK(run_espdiff("trajectory " + wild + " " + frames + " --source-frames " + four + " --reference previous -o " +
                    folder.file("b.csv"))
            .err == "espdiff: --source-frames and --reference previous exclude each other\n");
  CHECK(run_espdiff("trajectory " + wild + " " + frames + " --residue-quantity mean_slip_A -o " + folder.file("b.csv"))
            .err == "espdiff: --residue-quantity needs --residues FILE\n");
  // A field's column, where the field was asked for.
  const std::string of_field = "trajectory " + wild + " " + frames + " --frames 0 -q --residues " +
                               folder.file("q.csv") + " --residue-quantity charge_mean_abs_difference -o " +
                               folder.file("b.csv");
  CHECK(contains(run_espdiff(of_field).err, "residues have no quantity 'charge_mean_abs_difference'; there are: "));
  CHECK(run_espdiff(of_field + " --potential none --field charge").status == 0);
  CHECK_FALSE(column(folder.file("q.csv"), "A:ALA 1")[0].empty());
  std::filesystem::remove(folder.file("b.csv"));
  CHECK(run_espdiff("trajectory " + wild + " " + frames + " --residues " + frames + " -o " + folder.file("b.csv"))
            .status == 2);
  CHECK_FALSE(std::filesystem::exists(folder.file("b.csv")));
}

TEST_CASE("each frame against the one before, on the command line") {
  const ScratchFolder folder;
  const std::string wild = folder.write("wild.pqr", pqr()), frames = folder.write("wild.pdb", pdb_models(0, 3));
  REQUIRE(run_espdiff("trajectory " + wild + " " + frames + " --reference previous --potential none -q -o " +
                      folder.file("a.csv"))
              .status == 0);
  CHECK(column(folder.file("a.csv"), "frame") == std::vector<std::string>{"1", "2"});
  CHECK(column(folder.file("a.csv"), "reference_frame") == std::vector<std::string>{"0", "1"});
  CHECK(run_espdiff("trajectory " + wild + " " + frames + " --reference previous --frames-of " + wild + " -o " +
                    folder.file("b.csv"))
            .err ==
        "espdiff: --frames-of and --reference previous exclude each other; give the frames' own structure as "
        "SOURCE\n");
  CHECK_FALSE(std::filesystem::exists(folder.file("b.csv")));
}

#endif
