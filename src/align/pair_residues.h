// pair_residues.h: which residue of one molecule corresponds to which of the other.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "align/residue_names.h"
#include "base/types.h"

namespace espdiff {

/// A molecule as the pairing of residues sees it.
struct ResidueView {
  const Molecule* molecule = nullptr;
  std::vector<std::vector<std::size_t>> atoms;  ///< [residue][] atoms_of_residues()
  std::vector<ResidueKind> kinds;               ///< [residue] residue_kinds()

  explicit ResidueView(const Molecule& of)
      : molecule(&of), atoms(atoms_of_residues(of)), kinds(residue_kinds(of, atoms)) {}
};

/// Pairs residues. Amino acids and nucleotides by their chains' sequences: chains are taken by best alignment score
/// (the same chain name is preferred where scores are close), and stretches left over on both sides are tried again, so
/// that a file without chain names meets one with them. Chains whose score could be chance stay unpaired. Ligands,
/// ions, sugars and caps pair by name, with the closest number, in chains that correspond before others.
///
/// Waters do not pair: molecules that need an alignment number them independently.
/// @returns (source residue, target residue), ascending in the source residue; each residue at most once. Time O(n m)
/// in the
///          lengths of each pair of different chains, memory n m bytes for the longest pair.
std::vector<std::pair<std::size_t, std::size_t>> pair_residues(const ResidueView& source, const ResidueView& target);

}  // namespace espdiff
