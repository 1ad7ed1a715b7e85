// real_pairs.cpp: pairing and superposition of real molecules against known values.
#include <doctest/doctest.h>

#include "align/geometry/superpose.h"
#include "align/pair_atoms.h"
#include "io/structures/structure_file.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::real_input;

namespace {

double superposed_rmsd(const Molecule& a, const Molecule& b, const AtomPairing& pairing, AlignAtoms atoms) {
  return superpose(a.positions, b.positions, select_pairs(pairing, a, atoms)).rmsd_A;
}

}  // namespace

// DERIVED.txt: dTIM is a model with 100 substitutions on the yeast backbone.
TEST_CASE("TIM against its defective mutant: about 100 substitutions on one backbone") {
  const auto source_path = real_input("pair_tim_maps/scTIM_chainA.pqr"),
             target_path = real_input("pair_tim_maps/dTIM_chainA.pqr");
  if (!source_path || !target_path) return;
  const Molecule source = read_structure(*source_path), target = read_structure(*target_path);
  const AtomPairing pairing = pair_atoms(source, target);
  CHECK(pairing.method == "sequence alignment");
  CHECK(pairing.n_aligned_residues == 246);  // the mutant's; the parent has 247
  CHECK(pairing.n_substituted_residues == 100);
  CHECK(superposed_rmsd(source, target, pairing, AlignAtoms::kAll) < 0.35);
  CHECK(superposed_rmsd(source, target, pairing, AlignAtoms::kCAlpha) < 0.2);
}

// DERIVED.txt: 181L fitted on 3LZM: 162 C-alpha, 0.186 A.
TEST_CASE("T4 lysozyme L99A: one substitution, two residues missing at the end") {
  const auto source_path = real_input("pair_t4l_maps/3lzm.pqr"), target_path = real_input("pair_t4l_maps/181l_fit.pqr");
  if (!source_path || !target_path) return;
  const Molecule source = read_structure(*source_path), target = read_structure(*target_path);
  const AtomPairing pairing = pair_atoms(source, target);
  CHECK(pairing.n_aligned_residues == 162);
  CHECK(pairing.n_substituted_residues >= 1);
  CHECK(select_pairs(pairing, source, AlignAtoms::kCAlpha).size() == 162);
  CHECK(superposed_rmsd(source, target, pairing, AlignAtoms::kCAlpha) == doctest::Approx(0.186).epsilon(0.01));
}

TEST_CASE("models of one protein pair in order") {
  const auto source_path = real_input("series19_ubq_2k39/m00.pqr"),
             target_path = real_input("series19_ubq_2k39/m18.pqr");
  if (!source_path || !target_path) return;
  const Molecule source = read_structure(*source_path), target = read_structure(*target_path);
  const AtomPairing pairing = pair_atoms(source, target);
  CHECK(pairing.method == "same order");
  CHECK(pairing.pairs.size() == 1231);
  // README.md of the inputs: RMSD 1.7 to 6.6 A.
  const double rmsd_A = superposed_rmsd(source, target, pairing, AlignAtoms::kAll);
  CHECK(rmsd_A > 1.5);
  CHECK(rmsd_A < 6.8);
}

TEST_CASE("one molecule in two naming schemes and atom orders pairs by name") {
  const auto source_path = real_input("ubq/ubq.pqr"), target_path = real_input("series19_ubq_2k39/m00.pqr");
  if (!source_path || !target_path) return;
  const Molecule source = read_structure(*source_path), target = read_structure(*target_path);
  const AtomPairing pairing = pair_atoms(source, target);
  CHECK(pairing.method == "sequence alignment");
  CHECK(pairing.n_substituted_residues == 0);
  // All but HE2 of histidine 68, which is protonated at ND1 in the other.
  CHECK(pairing.pairs.size() == 1230);
}

TEST_CASE("CHARMM's and PDB's names of one structure bring every atom to its own position") {
#ifdef ESPDIFF_HAVE_GEMMI
  const auto source_path = real_input("ubq/ubq.pdb"), target_path = real_input("ubq/ubq.pqr");
  if (!source_path || !target_path) return;
  const Molecule source = read_structure(*source_path), target = read_structure(*target_path);
  const AtomPairing pairing = pair_atoms(source, target);
  CHECK(pairing.pairs.size() == 1231);
  std::size_t n_apart = 0;
  for (const auto& [i, j] : pairing.pairs) n_apart += norm(source.positions[i] - target.positions[j]) > 0.01 ? 1 : 0;
  CHECK(n_apart == 0);
#else
  MESSAGE("SKIPPED: this build reads no PDB files (no gemmi)");
#endif
}
