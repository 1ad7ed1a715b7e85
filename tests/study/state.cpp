// state.cpp: states as they are given, and as they are compared.
#include "study/state.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <thread>

#include "base/error.h"
#include "base/progress.h"
#include "matrix/variants.h"
#include "options/options.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff_test;  // NOLINT: a test
using espdiff::Cancelled;
using espdiff::ComparedState;
using espdiff::CompareOptions;
using espdiff::PotentialRequest;
using espdiff::Progress;
using espdiff::State;
using espdiff::StatePtr;
using espdiff::StateReader;
using espdiff::StateRole;

namespace {

/// A PQR of so many models of two atoms.
std::string models(int n) {
  std::string text;
  for (int i = 1; i <= n; ++i)
    text += "MODEL " + std::to_string(i) + "\nATOM  1  CA  ALA A  1  0.0 0.0 0.0  0.5 1.7\n" +
            "ATOM  2  C   ALA A  1  1.5 0.0 0.0  -0.2 1.7\nENDMDL\n";
  return text;
}

StatePtr file_state(const std::string& path, const std::string& sha256 = {}) {
  State state;
  state.path = path;
  state.input.sha256 = sha256;
  return std::make_shared<const State>(std::move(state));
}

/// A PDB file of one residue without charges.
StatePtr uncharged(const ScratchFolder& folder, const std::string& name) {
  return file_state(folder.write(name,
                                 "ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  0.00           N\n"
                                 "ATOM      2  CA  ALA A   1       1.460   0.000   0.000  1.00  0.00           C\n"
                                 "ATOM      3  C   ALA A   1       2.000   1.420   0.000  1.00  0.00           C\n"));
}

/// Takes the place of PDB2PQR until the end of the scope.
class StandIn {
 public:
  StandIn(const ScratchFolder& folder, const std::string& script) {
    const std::string path = folder.write("stand-in", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    setenv("ESPDIFF_PDB2PQR", path.c_str(), 1);
    setenv("XDG_CACHE_HOME", folder.file("cache").c_str(), 1);
  }
  ~StandIn() {
    unsetenv("ESPDIFF_PDB2PQR");
    unsetenv("XDG_CACHE_HOME");
  }
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;
};

ComparedState read_one(const StatePtr& state, const CompareOptions& options, const PotentialRequest& potential = {}) {
  return StateReader({options, potential}, {state}, {}).read(StateRole::kOnly);
}

}  // namespace

TEST_SUITE_BEGIN("study");

TEST_CASE("a structure that changes after its models were counted is refused") {
  const ScratchFolder folder;
  const std::string path = folder.write("one.pqr", models(2));
  const auto variants = espdiff::variants_of_files({path});
  const StatePtr state = file_state(path, variants[1].sha256);
  CHECK(read_one(state, {}).loaded.molecule.size() == 2);
  folder.write("one.pqr", models(3));
  CHECK(message_of([&] { read_one(state, {}); }) == path + ": the file was changed while it was in use; start again");
}

TEST_CASE("a state names its file, its role and the map that was computed for it") {
  const ScratchFolder folder;
  const StatePtr state = file_state(folder.write("one.pqr", models(1)));
  const CompareOptions options;
  PotentialRequest potential;
  potential.potential = "coulomb";
  StateReader reader({options, potential}, {state, state}, {});
  ComparedState source = reader.read(StateRole::kSource), target = reader.read(StateRole::kTarget);
  CHECK(reader.add_maps({&source, &target}).computes());
  REQUIRE(source.inputs.size() == 1);
  CHECK(source.inputs[0].role == "source");
  CHECK(source.inputs[0].path == state->path);
  REQUIRE(target.map_inputs.size() == 1);
  CHECK(target.map_inputs[0].role == "target_map");
  CHECK(source.side().make_map != nullptr);
}

TEST_CASE("settings of computed potentials are refused beside given maps, and without a potential") {
  const ScratchFolder folder;
  State mapped = *file_state(folder.write("one.pqr", models(1)));
  mapped.map = std::make_shared<const espdiff::Grid>();
  const StatePtr state = std::make_shared<const State>(mapped), plain = file_state(mapped.path);
  const CompareOptions options;
  const auto refusal = [&](const StatePtr& given, const PotentialRequest& potential) {
    return message_of([&] {
      StateReader reader({options, potential}, {given}, {});
      ComparedState one = reader.read(StateRole::kOnly);
      reader.add_maps({&one});
    });
  };
  PotentialRequest none{"none", "auto", {{"ionic-strength", "0.1"}}}, coulomb;
  coulomb.potential = "coulomb";
  CHECK(refusal(state, coulomb) == "potential and its options are of computed potentials, and maps were given");
  CHECK(refusal(plain, none) == "ionic-strength is of computed potentials, and none is computed");
}

TEST_CASE("a molecule whose atoms were chosen in VMD takes no selection of files") {
  const ScratchFolder folder;
  const StatePtr file = file_state(folder.write("one.pqr", models(1)));
  State state;
  state.molecule = read_one(file, {}).loaded.molecule;
  state.is_selected = true;
  CompareOptions options;
  const StatePtr given = std::make_shared<const State>(state);
  CHECK(read_one(given, options).loaded.molecule.size() == 2);
  options.input.both.select = "1";
  CHECK(message_of([&] { read_one(given, options); }) ==
        "select is of structures in files, and the molecule is a molecule of VMD; choose its atoms by `sel`");
}

TEST_CASE(
    "both states of a pair are prepared at once where there are two threads, and the source's error comes first") {
  const ScratchFolder folder;
  const StatePtr a = uncharged(folder, "a.pdb"), b = uncharged(folder, "b.pdb");
  // Each run waits for another one, and says whether it came.
  const std::string here = folder.file("");
  const StandIn program(folder, "touch " + here + "run.$$; for i in 1 2 3 4 5 6 7 8 9 10; do set -- " + here +
                                    "run.*; [ $# -ge 2 ] && touch " + here + "both; sleep 0.1; done; exit 1");
  const CompareOptions options;
  const auto error_of = [&](int n_threads) {
    return message_of([&] {
      StateReader reader({options, {}, false, false, n_threads}, {a, b}, {});
      const ComparedState source = reader.read(StateRole::kSource);
      reader.read(StateRole::kTarget, &source.loaded.molecule);
    });
  };
  const std::string one_by_one = error_of(1);
  CHECK_FALSE(std::filesystem::exists(folder.file("both")));
  CHECK(one_by_one.find("a.pdb: has no charges, and PDB2PQR cannot prepare it") != std::string::npos);
  for (const auto& entry : std::filesystem::directory_iterator(here)) {
    if (entry.path().filename().string().rfind("run.", 0) == 0) std::filesystem::remove(entry.path());
  }
  CHECK(error_of(2) == one_by_one);
  CHECK(std::filesystem::exists(folder.file("both")));
}

TEST_CASE("a cancelled preparation ends both programs within a second") {
  const ScratchFolder folder;
  const StatePtr a = uncharged(folder, "a.pdb"), b = uncharged(folder, "b.pdb");
  const std::string list = folder.file("processes");
  const StandIn program(folder, "echo $$ >> " + list + "; exec sleep 60");
  const CompareOptions options;
  Progress progress;
  const auto processes = [&] {
    std::istringstream text(std::filesystem::exists(list) ? read_file(list) : std::string());
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  };
  std::chrono::steady_clock::time_point cancelled;
  std::thread cancel([&] {
    for (int i = 0; i < 1000 && processes().size() < 2; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    cancelled = std::chrono::steady_clock::now();
    progress.request_cancel();
  });
  CHECK_THROWS_AS(StateReader({options, {}, false, false, 2}, {a, b}, progress).read(StateRole::kSource), Cancelled);
  const auto ended = std::chrono::steady_clock::now();
  cancel.join();
  CHECK(std::chrono::duration<double>(ended - cancelled).count() < 1);
  CHECK(processes().size() == 2);
  for (const std::string& process : processes()) CHECK_FALSE(std::filesystem::exists("/proc/" + process));
}
