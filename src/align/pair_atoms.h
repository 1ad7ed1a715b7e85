// pair_atoms.h: which atom of one molecule corresponds to which of the other.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Which paired atoms the superposition uses.
enum class AlignAtoms { kAll, kBackbone, kCAlpha, kNone };

/// @throws InputError for anything but all, backbone, ca, none
AlignAtoms parse_align_atoms(const std::string& text);

struct AtomPairing {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< (source atom, target atom), ascending in the source atom
  std::string method;                    ///< "same order" or "sequence alignment"
  std::size_t n_aligned_residues = 0;
  std::size_t n_substituted_residues = 0;  ///< aligned, with different names
};

/// Pairs all atoms: same count, names and residues in the same order pair one to one; else residues are paired by a global
/// alignment of the sequences, chain by chain, and atoms within paired residues by name (where the residue is substituted:
/// backbone and C-beta atoms only).
/// @throws InputError that lists what did not match, when fewer than 3 atoms pair
AtomPairing pair_atoms(const Molecule& source, const Molecule& target);

/// The pairs that `atoms` selects. Backbone: N, CA, C, O (proteins), P, O3', C3', C4', C5', O5' (nucleic acids).
/// @throws InputError when fewer than 3 pairs are left, with the choices that would do
std::vector<std::pair<std::size_t, std::size_t>> select_pairs(const AtomPairing& pairing, const Molecule& source,
                                                              AlignAtoms atoms);

}  // namespace espdiff
