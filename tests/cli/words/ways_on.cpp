// ways_on.cpp: which changes of a refused comparison are tried, and for how long.
#include "cli/words/ways_on.h"

#include <doctest/doctest.h>

#include "base/types.h"
#include "certificate/result.h"

using espdiff::cli::has_time_for;
using espdiff::cli::WayOn;
using espdiff::cli::ways_on;

namespace {

/// Chains of so many atoms each, one residue a chain.
espdiff::Molecule chains_of(const std::string& names, std::size_t n_atoms) {
  espdiff::Molecule molecule;
  for (const char name : names) {
    const auto residue = static_cast<std::int32_t>(molecule.residues.size());
    molecule.residues.push_back({"ALA", std::string(1, name), 1, ' '});
    for (std::size_t i = 0; i < n_atoms; ++i) {
      espdiff::Atom& atom = molecule.atoms.emplace_back();
      atom.residue = residue;
      molecule.positions.push_back({0, 0, 0});
    }
  }
  return molecule;
}

}  // namespace

TEST_CASE("a chain against a complex of four: the chain alone comes first, and costs what it has of the atoms") {
  espdiff::CompareResult result;
  result.inputs.chains = {{"A", "C", 298}};
  const auto ways = ways_on(result, chains_of("A", 100), chains_of("ABCD", 100), {}, {});
  REQUIRE(ways.size() == 2);
  CHECK(ways[0].what == "chain A with chain C alone");
  CHECK(ways[0].options[1].name == "target-select");
  CHECK(ways[0].options[1].value == "//C");
  CHECK(ways[0].size == doctest::Approx(200.0 / 500));
  CHECK(ways[1].exchanges);
  CHECK(ways[1].size == 1);
}

TEST_CASE("a tail that only one state has is left out, a missing residue and another numbering are not") {
  const auto chain = [](int from, int to) {
    espdiff::Molecule molecule;
    for (int number = from; number <= to; ++number) molecule.residues.push_back({"ALA", "X", number, ' '});
    return molecule;
  };
  espdiff::CompareResult result;
  result.inputs.chains = {{"X", "X", 76}};
  const auto first_of = [&](const espdiff::Molecule& source, const espdiff::Molecule& target,
                            const std::vector<std::string>& given) {
    return ways_on(result, source, target, given, {}).front();
  };
  const WayOn way = first_of(chain(1, 111), chain(-5, 76), {});
  CHECK(way.what == "without residues that only one state has");
  CHECK(way.options[0].name == "leave-out");
  CHECK(way.options[0].value == "//X/77-111 //X/-5-0");
  CHECK(first_of(chain(1, 80), chain(1, 76), {}).exchanges);
  CHECK(first_of(chain(1, 111), chain(1, 76), {"leave-out"}).exchanges);
  CHECK(first_of(chain(1, 111), chain(201, 311), {}).exchanges);
}

TEST_CASE("several chains are superposed each by itself before one of them is compared alone") {
  espdiff::CompareResult result;
  result.inputs.chains = {{"A", "A", 100}, {"B", "B", 100}};
  const auto ways = ways_on(result, chains_of("AB", 100), chains_of("AB", 100), {}, {});
  REQUIRE(ways.size() >= 2);
  CHECK(ways[0].options[0].value == "chains");
  CHECK(ways[1].what == "chain A alone");
  CHECK(ways_on(result, chains_of("AB", 100), chains_of("AB", 100), {"domains"}, {})[0].what == "chain A alone");
}

TEST_CASE("trials may take a minute, or as long as the answer took") {
  const WayOn whole{"", false, {}, 1}, part{"", false, {}, 0.4};
  CHECK(has_time_for(whole, 25, 30));
  CHECK_FALSE(has_time_for(whole, 25, 36));
  CHECK(has_time_for(part, 120, 70));  // 48 s more, of 120
  CHECK_FALSE(has_time_for(part, 120, 80));
  CHECK(has_time_for(whole, 120, 0));
}

TEST_CASE("charges of two force fields: that of the file with charges is tried for the one that was prepared") {
  espdiff::CompareResult result;
  result.potential.compared = true;
  const auto with_charge = [](float oxygen) {
    espdiff::Molecule molecule = chains_of("A", 5);
    for (std::size_t i = 0; i < 3; ++i) molecule.atoms[i].name = "O";
    molecule.charges = {oxygen, oxygen, -0.8F, 0, 0};
    molecule.radii.assign(5, 0);
    return molecule;
  };
  const espdiff::Molecule prepared = with_charge(-0.55F);
  const auto first = ways_on(result, with_charge(-0.51F), prepared, {}, {false, true}).front();
  REQUIRE(first.options.size() == 1);
  CHECK(first.options[0].name == "force-field");
  CHECK(first.options[0].value == "charmm");
  CHECK(ways_on(result, prepared, with_charge(-0.5679F), {}, {true, false}).front().options[0].value == "amber");
  // Where another one is asked for, none is known, or both were prepared.
  CHECK(ways_on(result, prepared, with_charge(-0.5679F), {"force-field"}, {true, false}).front().exchanges);
  CHECK(ways_on(result, prepared, with_charge(-0.5F), {}, {true, false}).front().exchanges);
  CHECK(ways_on(result, prepared, with_charge(-0.51F), {}, {true, true}).front().exchanges);
}
