// pair_atoms.h: pairs the atoms of two molecules.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "align/pair_residues.h"
#include "base/molecule/pairing.h"
#include "base/types.h"

namespace espdiff {

/// @throws InputError unless the text is all, backbone, ca or none
AlignAtoms parse_align_atoms(const std::string& text);
/// The text that parse_align_atoms() reads.
std::string to_string(AlignAtoms atoms);

/// Pairs all atoms. Molecules with the same count, names and residues in the same order pair one to one (chain names
/// may differ), if order_holds(). Otherwise residues are paired by a global alignment of the sequences, chain by chain
/// (pair_residues.h), and atoms within paired residues by name. In a substituted residue only backbone and C-beta atoms
/// pair: N, H, CA, HA, C, O, OXT, CB, or phosphate and sugar. Names are compared in a normalized spelling
/// (residue_names.h). Where two naming schemes number hydrogens differently (HB1, HB2 against HB2, HB3), equal names
/// pair first, then the others in order. Each atom pairs at most once.
/// @throws InputError listing what did not match, if fewer than 3 atoms pair
/// @param others how ligands, ions and waters pair, which need not have stayed in place
AtomPairing pair_atoms(const Molecule& source, const Molecule& target, PairOthers others = PairOthers::kByPlace);

/// The pairs that `atoms` selects; none for kNone. Backbone: N, CA, C, O (proteins), P, O3', C3', C4', C5', O5'
/// (nucleic acids). Atoms of ligands and ions with these names are not selected.
/// @throws InputError if fewer than 3 pairs remain; the message lists the choices that work
std::vector<std::pair<std::size_t, std::size_t>> select_pairs(const AtomPairing& pairing, const Molecule& source,
                                                              AlignAtoms atoms);

}  // namespace espdiff
