// commands.cpp: faults on purpose in preparations by PDB2PQR, ensembles, trajectories through VMD's readers, and
// verifications.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <set>
#include <sstream>
#include <thread>

#include "cli/run_espdiff.h"
#include "support/limit_memory.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// How many lines are no warnings.
std::size_t n_lines_besides_warnings(const std::string& text) {
  std::istringstream lines(text);
  std::size_t n = 0;
  for (std::string line; std::getline(lines, line);) n += line.rfind("espdiff: warning: ", 0) == 0 ? 0 : 1;
  return n;
}

/// All lines are ours, and one is no warning.
bool is_one_line_besides_warnings(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("espdiff: ", 0) != 0) return false;
  return n_lines_besides_warnings(text) == 1;
}

std::set<std::string> files_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

/// A structure without charges, and a program in PDB2PQR's place.
struct Preparation {
  ScratchFolder folder;
  Preparation() {
    std::string text;
    const char* const names[] = {"N", "CA", "C", "O"};
    for (int i = 0; i < 24; ++i) {
      char line[96];
      std::snprintf(line, sizeof line, "ATOM  %5d  %-3s ALA A%4d    %8.3f%8.3f%8.3f  1.00  0.00           %c\n", i + 1,
                    names[i % 4], i / 4 + 1, 1.4 * i, 0.8 * (i % 2), 0.4 * (i % 3), names[i % 4][0]);
      text += line;
    }
    folder.write("a.pdb", text);
    std::filesystem::create_directory(folder.file("tmp"));
  }
  void program(const std::string& body) const {
    const std::string path = folder.write("program", "#!/bin/sh\n" + body + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  /// @param before a shell's words before the program's name
  Outcome run(const std::string& before = "") const {
    return run_espdiff("prepare a.pdb -o out.pqr -q",
                       "cd " + folder.file("") + " && export TMPDIR=" + folder.file("tmp") +
                           " ESPDIFF_PDB2PQR=./program XDG_CACHE_HOME=/proc/none && " + before);
  }
  bool nothing_left() const {
    return files_in(folder.file("tmp")).empty() && !std::filesystem::exists(folder.file("out.pqr"));
  }
  /// Whether the program that wrote its number still runs.
  bool program_runs() const {
    const std::string number = read_file(folder.file("number"));
    return !number.empty() &&
           std::system(("kill -0 " + number.substr(0, number.find('\n')) + " 2>/dev/null").c_str()) == 0;
  }
};

/// Rows of atoms in two groups of two replicates.
struct Ensemble {
  ScratchFolder folder;
  Ensemble() {
    for (int r = 0; r < 4; ++r) {
      std::string text;
      for (int f = 0; f < 4; ++f) text += model(f + 1, r);
      folder.write("r" + std::to_string(r) + ".pqr", text);
    }
  }
  /// A row that wriggles.
  static std::string model(int frame, int replicate) {
    std::string text = "MODEL " + std::to_string(frame) + "\n";
    for (int i = 0; i < 6; ++i) {
      char line[128];
      std::snprintf(line, sizeof line, "ATOM %d CA ALA A %d %.3f %.3f %.3f 0.2 2.2\n", i + 1, i + 1, 2.4 * i,
                    0.3 * std::sin(1.7 * i + frame + 3 * replicate), 0.3 * std::cos(2.3 * i * frame));
      text += line;
    }
    return text + "ENDMDL\n";
  }
  Outcome run(const std::string& before = "", const std::string& more = "") const {
    return run_espdiff(
        "ensemble --group a r0.pqr r1.pqr --group b r2.pqr r3.pqr --grid-spacing 1 --potential coulomb "
        "--device cpu --threads 1 -q -o out " +
            more,
        "cd " + folder.file("") + " && " + before);
  }
};

}  // namespace

TEST_CASE("prepare: a signal ends PDB2PQR and its children, with one line, and leaves nothing") {
  const Preparation in;
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    CAPTURE(signal);
    in.program("echo $$ >'" + in.folder.file("number") + "'; kill -s " + signal + " $PPID; sleep 60 & wait");
    const Outcome outcome = in.run();
    CHECK(outcome.status == 1);
    CHECK_MESSAGE(is_one_line_besides_warnings(outcome.err), outcome.err);
    CHECK(contains(outcome.err, "cancelled; nothing was written"));
    CHECK(in.nothing_left());
    CHECK_FALSE(in.program_runs());
  }
}

TEST_CASE("prepare: after kill -9 the next run removes what the killed one left") {
  const Preparation in;
  in.program("kill -s KILL $PPID; sleep 2; exit 1");
  const Outcome killed = in.run();
  CHECK(killed.status == 137);
  CHECK(files_in(in.folder.file("tmp")).size() == 1);
  in.program("exit 1");
  const Outcome outcome = in.run();
  CHECK(outcome.status == 2);
  CHECK_MESSAGE(is_one_line_besides_warnings(outcome.err), outcome.err);
  CHECK(in.nothing_left());
}

TEST_CASE("prepare: a disk that is full before, while or after PDB2PQR writes is told in one line") {
  const Preparation in;
  // Files at their limit of size fail as on a full disk: our input, the program's output.
  in.program("exit 0");
  const Outcome before = in.run("ulimit -f 1 &&");
  CHECK(before.status == 2);
  CHECK_MESSAGE(is_one_line_besides_warnings(before.err), before.err);
  CHECK(contains(before.err, "input.pdb: cannot be written; is the disk full? Name another folder in TMPDIR"));
  CHECK(in.nothing_left());
  in.program("for word; do out=$word; done; head -c 100000 /dev/zero >\"$out\"");
  const Outcome meanwhile = in.run("ulimit -f 8 &&");
  CHECK(meanwhile.status == 2);
  CHECK_MESSAGE(is_one_line_besides_warnings(meanwhile.err), meanwhile.err);
  CHECK(in.nothing_left());
}

TEST_CASE("prepare: an output of PDB2PQR that is rubbish or of another molecule is not taken") {
  const Preparation in;
  for (const char* const output : {"", "rubbish", "ATOM 1 N ALA", "ATOM 1 N ALA A 1 nan 0 0 0 1", "\\377\\330\\000"}) {
    CAPTURE(output);
    in.program(std::string("for word; do out=$word; done; printf '") + output + "' >\"$out\"");
    const Outcome outcome = in.run();
    CHECK((outcome.status == 1 || outcome.status == 2));
    CHECK_MESSAGE(is_one_line_besides_warnings(outcome.err), outcome.err);
    CHECK(in.nothing_left());
  }
}

TEST_CASE("ensemble: a signal, a full disk and little memory end with one line; what was computed is resumed") {
  const Ensemble in;
  const Outcome whole = in.run();
  if (contains(whole.err, "HDF5")) {
    MESSAGE("SKIPPED: ", whole.err);
    return;
  }
  REQUIRE_MESSAGE(whole.status == 0, whole.err);
  const std::string expected = read_file(in.folder.file("out.h5"));
  int n_ended = 0;
  for (const char* const fault : {"timeout -s TERM 0.3", "timeout -s HUP 0.4", "ulimit -f 300 &&"}) {
    CAPTURE(fault);
    for (const std::string& name : files_in(in.folder.file(""))) {
      if (name.rfind("out", 0) == 0) std::filesystem::remove(in.folder.file(name));
    }
    const Outcome outcome = in.run(fault);
    if (outcome.status == 0) continue;  // was faster
    if (n_lines_besides_warnings(outcome.err) == 0) {
      // The signal came before it began or when all was done: nothing is half written.
      const bool is_begun = std::filesystem::exists(in.folder.file("out.h5"));
      CHECK((!is_begun || read_file(in.folder.file("out.h5")) == expected));
      continue;
    }
    ++n_ended;
    CHECK_MESSAGE(is_one_line_besides_warnings(outcome.err), outcome.err);
    for (const std::string& name : files_in(in.folder.file(""))) {
      CHECK_MESSAGE(!contains(name, ".tmp"), name);
      CHECK_MESSAGE(!contains(name, ".new-"), name);
    }
    const Outcome resumed = in.run("", "--resume");
    CHECK_MESSAGE(resumed.status == 0, resumed.err);
    CHECK(read_file(in.folder.file("out.h5")) == expected);
  }
  CHECK(n_ended > 0);  // the limit on the size of files always ends it
}

TEST_CASE("ensemble: two runs on one output: one is refused, and the file is whole") {
  const Ensemble in;
  const std::string run = std::string(ESPDIFF_BINARY) +
                          " ensemble --group a r0.pqr r1.pqr --group b r2.pqr r3.pqr --grid-spacing 0.7 --potential "
                          "coulomb --device cpu --threads 1 -q -o out --resume";
  const std::string command = "cd " + in.folder.file("") + " && (" + run + " 2>err1; echo $? >status1) & cd " +
                              in.folder.file("") + " && " + run + " 2>err2; echo $? >status2; wait";
  std::system(("bash -c '" + command + "'").c_str());
  const std::string errors = read_file(in.folder.file("err1")) + read_file(in.folder.file("err2"));
  if (contains(errors, "HDF5")) {
    MESSAGE("SKIPPED: ", errors);
    return;
  }
  const std::string statuses = read_file(in.folder.file("status1")) + read_file(in.folder.file("status2"));
  if (statuses != "0\n0\n") {
    CHECK((statuses == "0\n2\n" || statuses == "2\n0\n"));
    CHECK_MESSAGE(contains(errors, "another run is writing this file"), errors);
  }  // else the second began when the first had ended
  const Outcome from = run_espdiff("ensemble --from out.h5 -q -o again", "cd " + in.folder.file("") + " &&");
  CHECK_MESSAGE(from.status == 0, from.err);
}

TEST_CASE("trajectory: an absurd number of atoms in a DCD or topology of VMD's readers is refused before memory") {
  if (!can_limit_memory()) return;
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(2));
  folder.write("b.dcd", "2000000000 30\n0 0 0\n");
  const auto run = [&](const std::string& topology) {
    return run_espdiff(
        "trajectory " + topology + " b.dcd --plugins " ESPDIFF_MADE_PLUGINS " --device cpu -q -o out.csv",
        "cd " + folder.file("") + " && ulimit -v 2000000 &&");
  };
  const Outcome dcd = run("a.pqr");
  CHECK(dcd.status == 2);
  CHECK_MESSAGE(is_one_line_besides_warnings(dcd.err), dcd.err);
  CHECK(contains(dcd.err, "b.dcd: has 2000000000 atoms in each frame, and the structure has 2; "));
  folder.write("c.psf", "2000000000\nN ALA 1 PROT -0.5\n");
  folder.write("b.dcd", "2 30\n0 0 0 1 1 1\n");
  const Outcome psf = run("c.psf");
  CHECK(psf.status == 2);
  CHECK_MESSAGE(is_one_line_besides_warnings(psf.err), psf.err);
  CHECK(contains(psf.err, "c.psf: has 2000000000 atoms, and at most 5000000 are read"));
}

TEST_CASE("verify: records that name what is not there, or what no memory holds, are refused in one line") {
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(6));
  folder.write("b.pqr", row_of_atoms(6, 0.3));
  const std::string in_folder = "cd " + folder.file("") + (can_limit_memory() ? " && ulimit -v 4000000 &&" : " &&");
  REQUIRE(
      run_espdiff("compare a.pqr b.pqr --grid-spacing 1.5 --potential none --device cpu -q -o out", in_folder).status ==
      0);
  const Outcome whole = run_espdiff("verify out", in_folder);
  if (contains(whole.err, "VTK")) {
    MESSAGE("SKIPPED: ", whole.err);
    return;
  }
  const std::string record = read_file(folder.file("out.json"));
  const struct {
    const char *key, *value, *message;
  } changes[] = {
      {"\"grid_spacing_A\": ", "1e-9", "options/grid_spacing_A is 1e-09, and 0.001 to 100 was expected"},
      {"\"grid_spacing_A\": ", "-1", "options/grid_spacing_A is -1, and"},
      {"\"isovalue\": ", "0", "options/isovalue is 0, and"},
      {"\"radius_scale\": ", "1e300", "options/radius_scale is 1e+300, and"},
      {"\"paired_atoms\": ", "[[18446744073709551615, 0, 2]]", "paired_atoms names atoms that the structures lack"},
      {"\"grid_spacing_A\": ", "0.001", "memory"}};
  for (const auto& change : changes) {
    CAPTURE(change.value);
    const std::size_t at = record.find(change.key);
    REQUIRE(at != std::string::npos);
    const std::size_t begin = at + std::string(change.key).size();
    int depth = 0;
    std::size_t end = begin;
    for (; depth > 0 || (record[end] != ',' && record[end] != '\n' && record[end] != '}'); ++end)
      depth += record[end] == '[' ? 1 : record[end] == ']' ? -1 : 0;
    folder.write("out.json", record.substr(0, begin) + change.value + record.substr(end));
    const Outcome outcome = run_espdiff("verify out", in_folder);
    CHECK((outcome.status == 1 || outcome.status == 2));
    CHECK_MESSAGE(is_one_line_besides_warnings(outcome.err), outcome.err);
    CHECK_MESSAGE(contains(outcome.err, change.message), outcome.err);
  }
}
