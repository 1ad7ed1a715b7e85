// faults.cpp: kills, signals, full disks, closed streams and second runs: what is promised of them is kept.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// A source and three frames, small enough for a run of a second.
struct Frames {
  ScratchFolder folder;
  Frames() {
    folder.write("a.pqr", row_of_atoms(5));
    std::string frames;
    for (int i = 0; i < 6; ++i)
      frames += "MODEL " + std::to_string(i + 1) + "\n" + row_of_atoms(5, 0.1 * i) + "ENDMDL\n";
    folder.write("frames.pqr", frames);
    for (int i = 0; i < 4; ++i) folder.write("m" + std::to_string(i) + ".pqr", row_of_atoms(5, 0.2 * i));
  }
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    return run_espdiff(arguments + " --device cpu --threads 1 -q", "cd " + folder.file("") + " && " + before);
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.file("")))
      names.insert(entry.path().filename().string());
    return names;
  }
};

const char* const kTrajectory = "trajectory a.pqr frames.pqr --start previous --grid-spacing 1.5 -o ";
const char* const kMatrix = "matrix m0.pqr m1.pqr m2.pqr m3.pqr --grid-spacing 1.5 -o ";

/// The columns and rows, without the header.
std::string rows_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string rows;
  for (std::string line; std::getline(lines, line);) {
    if (line[0] != '#') rows += line + '\n';
  }
  return rows;
}

/// Seconds that a run takes.
template <typename Run>
double seconds_of(Run run) {
  const auto begin = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// What kills a command somewhere within `seconds`.
std::string kill_within(double seconds, std::mt19937& random) {
  char command[40];
  std::snprintf(command, sizeof command, "timeout -s KILL %.3f",
                0.005 + seconds * static_cast<double>(random()) / 4294967296.0);
  return command;
}

/// Runs a command once those that were killed are gone: `timeout` dies with what it kills, and does not wait for it.
template <typename Run>
Outcome run_when_free(Run run) {
  Outcome outcome = run();
  for (int i = 0; i < 100 && contains(outcome.err, "another run is writing this file"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    outcome = run();
  }
  return outcome;
}

bool is_one_line_of_ours(const std::string& text) { return text.rfind("espdiff: ", 0) == 0 && n_lines(text) == 1; }

}  // namespace

TEST_CASE("kill -9 at any time: a trajectory resumes to the same bytes, and nothing is left") {
  const Frames in;
  const double seconds = seconds_of([&] { REQUIRE(in.run(std::string(kTrajectory) + "whole.csv").status == 0); });
  const std::string expected = read_file(in.folder.file("whole.csv"));
  std::mt19937 random(42);
  int n_killed = 0, n_unfinished = 0;
  const auto is_temporary = [](const std::string& name) { return contains(name, ".tmp") || contains(name, ".old"); };
  for (int i = 0; i < 12; ++i) {
    const Outcome outcome = in.run(std::string(kTrajectory) + "out.csv --resume", kill_within(seconds, random));
    n_killed += outcome.status != 0 ? 1 : 0;
    if (outcome.status == 0) std::filesystem::remove(in.folder.file("out.csv"));  // begin anew
    const auto files = in.files();
    n_unfinished += std::any_of(files.begin(), files.end(), is_temporary) ? 1 : 0;
  }
  MESSAGE("killed ", n_killed, " of 12");
  CHECK(n_killed > 0);
  // A file is written without a name; only between getting one and the rename can a kill leave it.
  CHECK(n_unfinished <= 2);
  const Outcome last = run_when_free([&] { return in.run(std::string(kTrajectory) + "out.csv --resume"); });
  CHECK_MESSAGE(last.status == 0, last.err);
  CHECK(read_file(in.folder.file("out.csv")) == expected);
  const auto files = in.files();
  CHECK(files.count("out.csv.state") == 0);
  for (const std::string& name : files) CHECK_MESSAGE(!is_temporary(name), name);
}

TEST_CASE("kill -9 at any time: a matrix resumes to the same bytes, and nothing is left") {
  const Frames in;
  const double seconds = seconds_of([&] { REQUIRE(in.run(std::string(kMatrix) + "whole").status == 0); });
  std::mt19937 random(7);
  for (int i = 0; i < 12; ++i) {
    in.run(std::string(kMatrix) + "out --resume", kill_within(seconds, random));
    if (std::filesystem::exists(in.folder.file("out.csv"))) break;
  }
  if (!std::filesystem::exists(in.folder.file("out.csv"))) {
    const Outcome last = run_when_free([&] { return in.run(std::string(kMatrix) + "out --resume"); });
    CHECK_MESSAGE(last.status == 0, last.err);
  }
  for (const char* ending : {".csv", ".json"})
    CHECK(read_file(in.folder.file(std::string("out") + ending)) ==
          read_file(in.folder.file(std::string("whole") + ending)));
  for (const std::string& name : in.files()) {
    CHECK_MESSAGE(!contains(name, ".tmp"), name);
    CHECK_MESSAGE(!contains(name, ".state"), name);
  }
}

TEST_CASE("signals that can be caught end a run with one line and leave nothing half written") {
  const Frames in;
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    CAPTURE(signal);
    const auto before = in.files();
    Outcome outcome;
    // On a busy machine, or under a sanitizer, the first signals come before the program has begun.
    for (const char* const delay : {"0.3", "1.5", "6"}) {
      outcome =
          in.run("compare a.pqr m3.pqr --grid-spacing 0.1 -o out", "timeout -s " + std::string(signal) + " " + delay);
      if (!outcome.err.empty()) break;
    }
    CHECK_MESSAGE(is_one_line_of_ours(outcome.err), outcome.err);
    CHECK(contains(outcome.err, "cancelled; nothing was written"));
    CHECK(in.files() == before);
  }
}

TEST_CASE("a signal while files get their names comes too late: they are there, and nobody is told that they are not") {
  if (std::system("strace -V >/dev/null 2>&1") != 0) {
    MESSAGE("SKIPPED: strace, which sends a signal at a call, is not installed");
    return;
  }
  const Frames in;
  const std::string fault = "strace -f -qq -o /dev/null -e inject=rename,renameat,renameat2,linkat:signal=TERM:when=1 ";
  for (const auto& [arguments, file] :
       {std::pair{"surface a.pqr -o s.vtp", "s.vtp"}, std::pair{"potential a.pqr --method coulomb -o p.dx", "p.dx"},
        std::pair{"compare a.pqr m3.pqr -o out", "out.vtp"}}) {
    const Outcome outcome = in.run(std::string(arguments) + " --overwrite", fault);
    CHECK_MESSAGE(!contains(outcome.err, "cancelled"), outcome.err);
    const std::string missing = std::string("no ") + file;
    CHECK_MESSAGE(in.files().count(file) == 1, missing);
  }
}

TEST_CASE("a disk that is full, and a file at its limit of size, leave nothing") {
  const Frames in;
  const auto before = in.files();
  for (const char* verb :
       {"surface a.pqr -o out.vtp", "compare a.pqr m1.pqr -o out", "potential a.pqr --pad 5 -o out.dx"}) {
    CAPTURE(verb);
    const Outcome outcome = in.run(verb, "ulimit -f 4 &&");
    CHECK(outcome.status == 2);
    CHECK_MESSAGE(is_one_line_of_ours(outcome.err), outcome.err);
    CHECK(contains(outcome.err, "not written: "));
    CHECK(in.files() == before);
  }
}

TEST_CASE("closed standard streams are not taken for outputs") {
  const Frames in;
  REQUIRE(in.run("compare a.pqr m1.pqr --grid-spacing 1.5 -o good").status == 0);
  const std::string base = "compare a.pqr m1.pqr --grid-spacing 1.5 --device cpu --threads 1 --overwrite -o ";
  for (const char* closed : {"<&-", ">&-", "2>&-", "<&- >&- 2>&-"}) {
    CAPTURE(closed);
    const std::string command = "cd " + in.folder.file("") + " && " ESPDIFF_BINARY " " + base + "out " + closed;
    CHECK(std::system(command.c_str()) == 0);
    CHECK(read_file(in.folder.file("out.vtp")) == read_file(in.folder.file("good.vtp")));
    CHECK(read_file(in.folder.file("out.residues.csv")) == read_file(in.folder.file("good.residues.csv")));
  }
}

TEST_CASE("a reader that goes away does not end a run, nor leave half of it") {
  const Frames in;
  const std::string command = "cd " + in.folder.file("") +
                              " && { " ESPDIFF_BINARY
                              " compare a.pqr m1.pqr --grid-spacing 1.5 --device cpu -o out; echo $? >status; } | true";
  std::system(command.c_str());
  CHECK(read_file(in.folder.file("status")) == "0\n");
  CHECK(in.files().count("out.json") == 1);
}

TEST_CASE("two runs on one output: one is refused, and the other's file is its own") {
  const Frames in;
  const std::string run =
      std::string(ESPDIFF_BINARY) + " " + kTrajectory + "out.csv --resume --device cpu --threads 1 -q";
  const std::string command = "cd " + in.folder.file("") + " && (" + run + " 2>err1; echo $? >status1) & cd " +
                              in.folder.file("") + " && " + run + " 2>err2; echo $? >status2; wait";
  std::system(("bash -c '" + command + "'").c_str());
  const std::string statuses = read_file(in.folder.file("status1")) + read_file(in.folder.file("status2"));
  const std::string errors = read_file(in.folder.file("err1")) + read_file(in.folder.file("err2"));
  const std::string csv = rows_of(read_file(in.folder.file("out.csv")));
  CHECK(n_lines(csv) == 7);  // the columns and six frames, whoever wrote them
  if (statuses != "0\n0\n") {
    CHECK((statuses == "0\n2\n" || statuses == "2\n0\n"));
    CHECK(contains(errors, "another run is writing this file"));
  }  // else the second began when the first had ended
}

TEST_CASE("what no permission allows is told before the work") {
  const Frames in;
  const Outcome outcome = in.run("surface a.pqr -o /proc/out.vtp");
  CHECK(outcome.status == 2);
  CHECK_MESSAGE(is_one_line_of_ours(outcome.err), outcome.err);
}
