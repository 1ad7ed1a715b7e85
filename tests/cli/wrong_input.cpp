// wrong_input.cpp: every wrong input of the issue list gives one clear line, the right exit status, and leaves nothing
// behind.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/run_espdiff.h"
#include "io/files/sha256.h"

using namespace espdiff_test;  // NOLINT: a test

namespace {

/// A folder with two molecules and maps that fit them, and a way to spoil one input.
struct WrongInputs {
  ScratchFolder folder;
  std::string source = folder.write("a.pqr", row_of_atoms(8));
  std::string target = folder.write("b.pqr", row_of_atoms(8, 0.2));
  std::string source_map = folder.write("a.dx", constant_dx(33, 2.0, 1.0));
  std::string target_map = folder.write("b.dx", constant_dx(33, 2.0, 3.0));
  std::size_t n_before = 0;

  Outcome compare(const std::string& more = "", const std::string& output = "") {
    n_before = folder.n_files();
    return run_espdiff("compare " + source + " " + target + " --source-map " + source_map + " --target-map " +
                       target_map + " -o " + (output.empty() ? folder.file("out") : output) + " " + more);
  }
  void check_refused(const Outcome& outcome, int status, const std::string& expected) {
    CHECK_MESSAGE(outcome.status == status, outcome.err);
    CHECK_MESSAGE(contains(outcome.err, expected), outcome.err);
    CHECK_MESSAGE(n_lines(outcome.err) == 1, outcome.err);
    CHECK(outcome.out.empty());
    CHECK(folder.n_files() == n_before);
  }
};

}  // namespace

TEST_CASE("good input: the files, and a constant difference") {
  WrongInputs in;
  const Outcome outcome = in.compare();
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  for (const char* suffix : {".json", ".vtp", ".residues.csv"})
    CHECK(std::filesystem::exists(in.folder.file("out") + suffix));
  CHECK(contains(read_file(in.folder.file("out.json")), "\"mean_signed_difference\": 2.0"));
  CHECK(contains(outcome.out, "kT/e"));
}

TEST_CASE("a missing file") {
  WrongInputs in;
  in.source = in.folder.file("absent.pqr");
  in.check_refused(in.compare(), 2, "absent.pqr: ");
}

TEST_CASE("a text with another program's format characters is shown as it was given") {
  WrongInputs in;
  const Outcome outcome = in.compare("--domains %s%n");
  CHECK(outcome.status == 2);
  CHECK_MESSAGE(contains(outcome.err, "--domains: '%s%n' has an unreadable range of residues, '%s%n'; give"),
                outcome.err);
}

TEST_CASE("a folder instead of a file") {
  WrongInputs in;
  in.target = std::filesystem::temp_directory_path().string();
  in.check_refused(in.compare(), 2, "directory");
}

TEST_CASE("a DX file cut off") {
  WrongInputs in;
  in.source_map = in.folder.write("cut.dx", constant_dx(33, 2.0, 1.0).substr(0, 5000));
  in.check_refused(in.compare(), 2, "cut.dx:");
}

TEST_CASE("a DX file with fewer values than promised") {
  WrongInputs in;
  in.target_map = in.folder.write("few.dx", constant_dx(33, 2.0, 1.0, "kT/e", 0, 1000));
  in.check_refused(in.compare(), 2, "35937");
}

TEST_CASE("coordinates that are not numbers") {
  WrongInputs in;
  in.source = in.folder.write("nan.pqr", "ATOM      1  CA  ALA A   1         nan   0.000   0.000  0.5000 2.0000\n");
  in.check_refused(in.compare(), 2, "nan.pqr:1:");
}

TEST_CASE("no atoms") {
  WrongInputs in;
  in.source = in.folder.write("empty.pqr", "REMARK nothing here\nEND\n");
  in.check_refused(in.compare(), 2, "empty.pqr");
}

TEST_CASE("two molecules with nothing in common") {
  WrongInputs in;
  std::string other = row_of_atoms(8, 0, "LYS");
  for (std::size_t at = 0; (at = other.find(" CA ", at)) != std::string::npos; ++at) other.replace(at, 4, " QX ");
  in.target = in.folder.write("other.pqr", other);
  in.check_refused(in.compare(), 2, "--align none");
}

TEST_CASE("options that the core names are spelled as the command line's, and plainly in files") {
  WrongInputs in;
  in.check_refused(in.compare("--mu 0.5"), 2,
                   "--mu is a setting of the method deform, and the method is morph; give --method deform as well, or "
                   "leave --mu out");
  in.check_refused(in.compare("--device cuda:999"), 1, "--device cuda:999: ");
  const Outcome outcome = in.compare("--method deform --max-iterations 1 --exit-zero --no-trials");
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "  - the mapping did not converge; raise --max-iterations\n"));
  CHECK(contains(read_file(in.folder.file("out.json")), "\"the mapping did not converge; raise max-iterations\""));
}

TEST_CASE("a map that does not cover the molecule") {
  WrongInputs in;
  in.target_map = in.folder.write("far.dx", constant_dx(9, 1.0, 1.0, "kT/e", 500));
  in.check_refused(in.compare(), 2, "does not cover");
}

TEST_CASE("a map on one side only") {
  WrongInputs in;
  in.n_before = in.folder.n_files();
  const Outcome outcome = run_espdiff("compare " + in.source + " " + in.target + " --source-map " + in.source_map +
                                      " -o " + in.folder.file("out"));
  in.check_refused(outcome, 2, "--target-map");
}

TEST_CASE("maps in two units: converted when both are known, refused when one is not") {
  WrongInputs in;
  in.target_map = in.folder.write("volt.dx", constant_dx(33, 2.0, 1.0, "V"));
  in.target_map = in.folder.write("unknown.dx", constant_dx(33, 2.0, 1.0, "bananas"));
  in.check_refused(in.compare(), 2, "two units");
  // 25.852 mV is kT/e at 300 K.
  in.target_map = in.folder.write("mv.dx", constant_dx(33, 2.0, 25.852, "mV"));
  const Outcome outcome = in.compare("--target-map-unit mV");
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "kT/e"));
  CHECK(contains(read_file(in.folder.file("out.json")), "\"mean_abs_difference\": "));
}

TEST_CASE("an output that cannot be written is found before the work") {
  WrongInputs in;
  in.check_refused(in.compare("", "/no/such/folder/out"), 2, "/no/such/folder/out");
  std::filesystem::create_directory(in.folder.file("taken.vtp"));
  in.check_refused(in.compare("", in.folder.file("taken")), 2, "taken.vtp");
}

TEST_CASE("a structure through a pipe is what a file of it is, hash and all") {
  const ScratchFolder folder;
  const std::string text = row_of_atoms(9);
  const std::string a = folder.write("a.pqr", text), b = folder.write("b.pqr", row_of_atoms(9, 1));
  const Outcome by_file = run_espdiff("compare " + a + " " + b + " -o " + folder.file("file"));
  REQUIRE_MESSAGE(by_file.status == 0, by_file.err);
  const std::string through =
      "cat " + a + " | sh -c '" ESPDIFF_BINARY " compare /dev/fd/3 " + b + " -q -o " + folder.file("pipe") + " 3<&0'";
  REQUIRE(std::system(through.c_str()) == 0);
  CHECK(read_file(folder.file("pipe.residues.csv")) == read_file(folder.file("file.residues.csv")));
  CHECK(contains(read_file(folder.file("pipe.json")), espdiff::sha256_of(text)));
}

TEST_CASE("a grid too large for memory") {
  WrongInputs in;
  const Outcome outcome = in.compare("--grid-spacing 0.001");
  in.check_refused(outcome, 1, "would fit");
}

TEST_CASE("an isovalue above the density") {
  WrongInputs in;
  in.check_refused(in.compare("--isovalue 1000"), 1, "no surface");
}

TEST_CASE("a model that does not exist") {
  WrongInputs in;
  in.check_refused(in.compare("--source-model 7"), 2, "model");
}

TEST_CASE("mmCIF under a PDB name is read as what it is") {
  const auto path = real_input("calb/1TCA.pdb");
  if (!path) return;
  const ScratchFolder folder;
  const Outcome outcome = run_espdiff("surface " + *path + " -o " + folder.file("s.vtp"));
  if (contains(outcome.err, "gemmi")) {
    MESSAGE("SKIPPED: this build has no mmCIF reader");
    return;
  }
  CHECK_MESSAGE(outcome.status == 0, outcome.err);
  CHECK(contains(outcome.out, "vertices"));
  CHECK(std::filesystem::exists(folder.file("s.vtp")));
}

TEST_CASE("Ctrl-C in the middle leaves nothing half written") {
  const auto path = real_input("ref_apbs/1tca.pqr");
  if (!path) return;
  const ScratchFolder folder;
  const Outcome outcome =
      run_espdiff("compare " + *path + " " + *path + " --grid-spacing 0.4 --method deform --min-displacement 0 -o " +
                      folder.file("out"),
                  "timeout -s INT 1.5");
  CHECK_MESSAGE(outcome.status == 124, outcome.status);  // of timeout: the time was up
  CHECK_MESSAGE(contains(outcome.err, "cancelled; nothing was written"), outcome.err);
  CHECK(folder.n_files() == 0);
}

TEST_CASE("an empty argument, as of a variable that is not set, is refused wherever it stands") {
  const ScratchFolder folder;
  folder.write("a.pqr", row_of_atoms(4));
  const std::string where = "cd " + folder.file("") + " &&";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"compare '' a.pqr", "compare"},
      {"a.pqr ''", "a.pqr"},
      {"surface '' -o s.vtp", "surface"},
      {"surface a.pqr -o ''", "-o"},
      {"verify ''", "verify"},
      {"compare a.pqr a.pqr --source-map ''", "--source-map"},
      {"compare a.pqr a.pqr --select ''", "--select"},
      {"ensemble --group A '' --group B a.pqr -o e", "A"}};
  for (const auto& one : cases) {
    const auto& [arguments, before] = one;
    CAPTURE(one.first);
    const Outcome outcome = run_espdiff(arguments, where);
    CHECK(outcome.status == 2);
    CHECK_MESSAGE(contains(outcome.err, "espdiff: there is an empty argument behind '" + before +
                                            "', as of a variable that is not set; give a name, or leave it out"),
                  outcome.err);
    CHECK(n_lines(outcome.err) == 1);
    CHECK(folder.n_files() == 1);
  }
}
