// pair_residues.h: pairs the residues of two molecules.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "align/residue_names.h"
#include "base/molecule/pairing.h"
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

/// Pairs of residues: (source residue, target residue), ascending in the source residue; each residue at most once.
struct ResiduePairing {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  bool by_names = false;              ///< by chain, number and name, since the files list them in different orders
  std::vector<MovedResidue> moved{};  ///< see pair_by_place()
  std::vector<std::pair<std::string, std::string>> exchanged_chains{};
};

/// What decides between residues of one name that are no part of a polymer.
enum class PairOthers { kByPlace, kByNumber };

/// Pairs residues. Amino acids and nucleotides pair by their chains' sequences. Chains are taken by best alignment
/// score; the same chain name is preferred if scores are close. Stretches that remain on both sides are tried again, so
/// a file without chain names can pair with one that has them. Chains whose score could be chance stay unpaired. Among
/// equal chains, their arrangement decides; see assign_chains(). Files that list the same residues in different orders
/// pair by chain, number and name; a residue whose name alone differs is a substituted one.
///
/// Ligands, ions, sugars, caps and waters pair by place; see pair_by_place(). By number, and where no polymer pairs,
/// they pair by name with the closest number, in corresponding chains first, and waters do not pair.
/// @returns the pairs. Time O(n m) in the lengths of each pair of different chains, memory n m bytes for the longest
/// pair.
ResiduePairing pair_residues(const ResidueView& source, const ResidueView& target,
                             PairOthers others = PairOthers::kByPlace);

/// Whether molecules that list the same residues in the same order also pair in this order: they do not list chains of
/// the same names in different orders, no other assignment of equal chains fits clearly better, and ligands, ions and
/// waters are in their places.
bool order_holds(const ResidueView& source, const ResidueView& target);

}  // namespace espdiff
