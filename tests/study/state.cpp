// state.cpp: states as they are given, and as they are compared.
#include "study/state.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "matrix/variants.h"
#include "options/options.h"
#include "support/test_data.h"
#include "support/text.h"

using namespace espdiff_test;  // NOLINT: a test
using espdiff::ComparedState;
using espdiff::CompareOptions;
using espdiff::PotentialRequest;
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
