// Protonation states from hydrogens, and their differences.
#include "align/protonation.h"

#include <doctest/doctest.h>

#include "align/compared_chains.h"
#include "made_molecule.h"

using namespace espdiff;
using espdiff_test::MadeMolecule;

namespace {

std::string state_of(const std::string& name, std::vector<std::string> atoms) {
  MadeMolecule made;
  atoms.insert(atoms.begin(), {"N", "CA", "C", "O", "H"});
  made.residue("A", 1, name, atoms);
  return protonation_states(made.molecule)[0];
}

}  // namespace

TEST_CASE("protonation_states: by the hydrogens, whatever the residue is called") {
  CHECK(state_of("ASP", {}) == "ASP");
  CHECK(state_of("ASP", {"HD2"}) == "ASH");
  CHECK(state_of("GLU", {"HE2"}) == "GLH");
  CHECK(state_of("HIS", {"HD1", "HD2", "HE1"}) == "HID");
  CHECK(state_of("HSE", {"HE2"}) == "HIE");
  CHECK(state_of("HIE", {"HD1", "HE2"}) == "HIP");
  CHECK(state_of("LYS", {"HZ1", "HZ2", "HZ3"}) == "LYS");
  CHECK(state_of("LYS", {"HZ2", "HZ3"}) == "LYN");
  CHECK(state_of("TYR", {"HH"}) == "TYR");
  CHECK(state_of("TYR", {}) == "TYM");
  CHECK(state_of("CYS", {"SG"}) == "CYM");
  CHECK(state_of("ALA", {}) == "");
  MadeMolecule bare;
  bare.residue("A", 1, "ASP", {"N", "CA", "C", "O"});
  CHECK(protonation_states(bare.molecule)[0] == "");
}

TEST_CASE("protonation_states: two sulfurs at 2 A are a disulfide") {
  MadeMolecule made;
  made.residue("A", 1, "CYS", {"N", "CA", "SG", "H"});
  made.residue("A", 2, "CYS", {"N", "CA", "SG", "H"});
  made.molecule.positions[2] = {0, 0, 0};
  made.molecule.positions[6] = {2.04, 0, 0};
  CHECK(protonation_states(made.molecule) == std::vector<std::string>{"CYX", "CYX"});
}

TEST_CASE("protonation_differences: states and chain ends of paired residues") {
  MadeMolecule a, b;
  a.residue("A", 1, "HIS", {"N", "CA", "C", "O", "H", "H2", "H3", "HD1"});
  b.residue("A", 1, "HIS", {"N", "CA", "C", "O", "H", "HD1", "HE2"});
  a.residue("A", 2, "ASP", {"N", "CA", "C", "O", "H"});
  b.residue("A", 2, "ASP", {"N", "CA", "C", "O", "H"});
  const auto differences = protonation_differences(a.molecule, b.molecule, {0, 1});
  REQUIRE(differences.size() == 2);
  CHECK(in_words(differences[0], a.molecule) == "HIS 1 of chain A: HID in the source, HIP in the target");
  CHECK(in_words(differences[1], a.molecule) ==
        "HIS 1 of chain A: N-terminus in the source, within the chain in the target");
  CHECK(protonation_differences(a.molecule, b.molecule, {-1, 1}).empty());
}

TEST_CASE("compared_chains and repeated_chains: a dimer whose chains are named otherwise") {
  MadeMolecule a, b;
  a.peptide("A", 1, "ARNDCQEGHI");
  a.peptide("B", 1, "ARNDCQEGHI");
  a.peptide("C", 1, "WWWWWWWW");
  b.peptide("X", 1, "ARNDCQEGHI");
  CHECK(repeated_chains(a.molecule) == std::vector<std::vector<std::string>>{{"A", "B"}});
  CHECK(repeated_chains(b.molecule).empty());
  std::vector<std::int32_t> target_of(a.molecule.residues.size(), -1);
  for (std::size_t r = 10; r < 20; ++r) target_of[r] = static_cast<std::int32_t>(r - 10);
  const auto chains = compared_chains(a.molecule, b.molecule, target_of);
  REQUIRE(chains.size() == 1);
  CHECK(in_words(chains) == "B with X");
  CHECK(chains[0].n_residues == 10);
}
