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
/// The text that parse_align_atoms() reads.
std::string to_string(AlignAtoms atoms);

struct AtomPairing {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< (source atom, target atom), ascending in the source atom
  std::string method;                                      ///< "same order" or "sequence alignment"
  std::size_t n_aligned_residues = 0;
  std::size_t n_substituted_residues = 0;  ///< aligned, with different names
};

/// Pairs all atoms: same count, names and residues in the same order pair one to one (chain names may differ); else
/// residues are paired by a global alignment of the sequences, chain by chain (pair_residues.h), and atoms within
/// paired residues by name. Where the residue is substituted only backbone and C-beta atoms pair: N, H, CA, HA, C, O,
/// OXT, CB, or phosphate and sugar. Names are compared in one spelling (residue_names.h). Hydrogens that two naming
/// schemes number differently (HB1, HB2 against HB2, HB3): equal names first, then the others in order. Each atom pairs
/// at most once.
/// @throws InputError that lists what did not match, when fewer than 3 atoms pair
AtomPairing pair_atoms(const Molecule& source, const Molecule& target);

/// The pairs that `atoms` selects; none for kNone. Backbone: N, CA, C, O (proteins), P, O3', C3', C4', C5', O5'
/// (nucleic acids); atoms of ligands and ions with these names do not count.
/// @throws InputError when fewer than 3 pairs are left, with the choices that would do
std::vector<std::pair<std::size_t, std::size_t>> select_pairs(const AtomPairing& pairing, const Molecule& source,
                                                              AlignAtoms atoms);

}  // namespace espdiff
