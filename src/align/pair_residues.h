// pair_residues.h: pairs the residues of two molecules.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "align/residue_names.h"
#include "base/types.h"

namespace espdiff {

/// A molecule with the tables that pairing residues needs.
struct ResidueView {
  const Molecule* molecule = nullptr;
  std::vector<std::vector<std::size_t>> atoms;  ///< [residue][] atoms_of_residues()
  std::vector<ResidueKind> kinds;               ///< [residue] residue_kinds()

  explicit ResidueView(const Molecule& of)
      : molecule(&of), atoms(atoms_of_residues(of)), kinds(residue_kinds(of, atoms)) {}
};

/// Pairs residues. Amino acids and nucleotides pair by their chains' sequences. Chains are taken by best alignment
/// score; the same chain name is preferred if scores are close. Stretches that remain on both sides are tried again, so
/// a file without chain names can pair with one that has them. Chains whose score could be chance stay unpaired.
/// Ligands, ions, sugars and caps pair by name with the closest number, in corresponding chains first.
///
/// Waters do not pair: molecules that need an alignment number them independently.
/// @returns (source residue, target residue), ascending in the source residue; each residue at most once. Time O(n m)
/// in the lengths of each pair of different chains, memory n m bytes for the longest pair.
std::vector<std::pair<std::size_t, std::size_t>> pair_residues(const ResidueView& source, const ResidueView& target);

}  // namespace espdiff
