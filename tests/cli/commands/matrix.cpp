// matrix.cpp: `espdiff matrix` and `espdiff merge`: whole, in parts, killed and resumed, and wrong usage.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/run_espdiff.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// Four molecules that differ, with groups.
struct MatrixFiles {
  ScratchFolder folder;
  std::string molecules, groups;
  MatrixFiles() {
    for (int i = 0; i < 4; ++i) {
      const std::string name = "m" + std::to_string(i) + ".pqr";
      molecules += " " + folder.write(name, row_of_atoms(9 + i, 0.3 * i));
    }
    groups = folder.write("groups.csv", "label,group\nm0,A\nm1,A\nm2,B\nm3,B\n");
  }
  std::string out(const std::string& name) const { return folder.file(name); }
  Outcome matrix(const std::string& name, const std::string& more = "") const {
    return run_espdiff("matrix" + molecules + " --potential pme --pme-grid 1 --align all -o " + out(name) + " " + more);
  }
};

}  // namespace

TEST_CASE("a matrix of files prints its sum and writes both files") {
  const MatrixFiles files;
  const Outcome outcome = files.matrix("m", "--groups " + files.groups);
  REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out,
                 "4 variants, 12 ordered pairs, potentials: pme part full grid 1 ewaldfactor 0.25 spline 6 precision "
                 "single compatible 0"));
  CHECK(contains(outcome.out, "12 pairs computed in"));
  CHECK(contains(outcome.out, "s a pair"));
  CHECK(contains(outcome.out, "Means of groups"));
  const std::string csv = read_file(files.out("m.csv"));
  CHECK(n_lines(csv) == 13);
  CHECK(contains(csv, "\nm0,m2,A,B,kT/e in vacuum,"));
  CHECK(contains(read_file(files.out("m.json")), "\"clustering\""));
  CHECK_FALSE(std::filesystem::exists(files.out("m.state")));
}

TEST_CASE("any number of threads gives the same bytes") {
  const MatrixFiles files;
  REQUIRE(files.matrix("one", "--threads 1 -q").status == 0);
  REQUIRE(files.matrix("three", "--threads 3 -q").status == 0);
  CHECK(read_file(files.out("one.json")) == read_file(files.out("three.json")));
}

TEST_CASE("a run that was killed continues and writes the same bytes") {
  const MatrixFiles files;
  REQUIRE(files.matrix("whole", "-q").status == 0);
  // Killed as soon as the state file has a few rows: by a watcher, since the time that takes is not known.
  const std::string state = files.out("killed.state");
  const Outcome outcome =
      run_espdiff("matrix" + files.molecules + " --potential pme --pme-grid 1 --align all -q -o " + files.out("killed"),
                  "sh -c '( while [ $(cat " + state +
                      " 2>/dev/null | wc -l) -lt 5 ]; do sleep 0.01; done; kill -9 $$ ) & exec \"$@\"' sh");
  CHECK(outcome.status != 0);
  REQUIRE(std::filesystem::exists(state));
  CHECK_FALSE(std::filesystem::exists(files.out("killed.json")));
  const std::size_t n_rows = n_lines(read_file(state)) - 2;
  const Outcome again = files.matrix("killed");
  CHECK(again.status == 2);
  CHECK(contains(again.err, "--resume continues it"));
  // One remedy for a state that cannot be continued, whether or not --resume is given.
  std::ofstream(files.out("cut.state")) << read_file(state).substr(0, 60);
  for (const char* resume : {"", "--resume"}) {
    const Outcome cut = files.matrix("cut", resume);
    CHECK(cut.status == 2);
    CHECK(cut.err == "espdiff: " + files.out("cut.state") +
                         ":2: the state file is cut off before its first row; run anew (--overwrite)\n");
  }
  const Outcome resumed = files.matrix("killed", "--resume");
  REQUIRE_MESSAGE(resumed.status == 0, resumed.err);
  CHECK(contains(resumed.out, std::to_string(n_rows) + " were there already"));
  CHECK(read_file(files.out("killed.json")) == read_file(files.out("whole.json")));
  CHECK(read_file(files.out("killed.csv")) == read_file(files.out("whole.csv")));
}

TEST_CASE("parts of several processes merge into the same bytes") {
  const MatrixFiles files;
  REQUIRE(files.matrix("whole", "-q").status == 0);
  for (int i = 1; i <= 5; ++i) REQUIRE(files.matrix("part", "-q --shard " + std::to_string(i) + "/5").status == 0);
  const Outcome merged = run_espdiff("merge " + files.out("part.shard-*-of-5.state") + " -o " + files.out("merged"));
  REQUIRE_MESSAGE(merged.status == 0, merged.err);
  CHECK(contains(merged.out, "4 variants, 12 ordered pairs"));
  CHECK(read_file(files.out("merged.json")) == read_file(files.out("whole.json")));
  CHECK(read_file(files.out("merged.csv")) == read_file(files.out("whole.csv")));
}

TEST_CASE("a changed input or a damaged state file is named, and nothing is lost") {
  const MatrixFiles files;
  REQUIRE(files.matrix("part", "-q --shard 1/2").status == 0);
  const std::string state = files.out("part.shard-1-of-2.state"), content = read_file(state);
  files.folder.write("m3.pqr", row_of_atoms(13));
  const Outcome changed = files.matrix("part", "--shard 1/2 --resume");
  CHECK(changed.status == 2);
  CHECK(contains(changed.err, "the structure of m3 has changed"));
  CHECK(read_file(state) == content);
  std::string damaged = content;
  damaged[damaged.size() / 2] ^= 1;
  files.folder.write("part.shard-1-of-2.state", damaged);
  const Outcome refused = files.matrix("part", "--shard 1/2 --resume");
  CHECK(refused.status == 2);
  CHECK(contains(refused.err, "part.shard-1-of-2.state:"));
  CHECK(contains(refused.err, "the state file is damaged from this line on"));
}

TEST_CASE("wrong usage of matrix and merge exits 2 with one line") {
  const MatrixFiles files;
  const std::string output = " -o " + files.out("x");
  for (const auto& wrong : std::vector<std::pair<std::string, std::string>>{
           {"matrix" + output, "no molecules were given"},
           {"matrix a.pqr --list b.csv" + output, "leave one out"},
           {"matrix " + files.out("m0.pqr") + output, "a matrix of 1 variant was asked for"},
           {"matrix" + files.molecules + " --shard 3/2" + output, "is not i/n"},
           {"matrix" + files.molecules + " --resume --overwrite" + output, "exclude each other"},
           {"matrix" + files.molecules + " --cluster-by size" + output, "there is no metric 'size'; there are: rmsd_A"},
           {"matrix" + files.molecules + " --groups " + files.out("absent.csv") + output, "absent.csv"},
           {"matrix" + files.molecules + " -o /nonexistent/x", "does not exist"},
           {"merge " + files.out("m0.pqr") + output, "no state file of a matrix"}}) {
    const Outcome outcome = run_espdiff(wrong.first);
    CHECK_MESSAGE(outcome.status == 2, wrong.first);
    CHECK_MESSAGE(contains(outcome.err, wrong.second), outcome.err);
    CHECK_MESSAGE(n_lines(outcome.err) <= 2, outcome.err);
  }
  CHECK(files.folder.n_files() == 5);
}
