// atom_paths.h: the ways of all atoms from source to target, for the morph.
#pragma once

#include <vector>

#include "align/pair_atoms.h"
#include "compare/domain_motions.h"
#include "engine/morph_stage.h"

namespace espdiff {

/// Paired atoms go from where they are to where their counterpart is, straight or with the rigid domain that their
/// residue belongs to. Atoms left over in paired residues, as
/// by a substitution, pair with the nearest one left over in the other, hydrogens among themselves, within 2.5 A. Any
/// other atom without a counterpart grows out of, or shrinks into, its *anchor*, the nearest paired atom of its residue
/// (of the molecule where its residue has none), so that a side chain sprouts instead of appearing in free space;
/// farther than 8 A from it, it appears or vanishes in place, moving as its anchor does.
/// @param from_source, from_target own frames -> common frame
/// @throws InputError when no atoms pair
std::vector<MovingAtom> atom_paths(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                                   const RigidTransform& from_source, const RigidTransform& from_target,
                                   const DomainMotions& domains, double radius_scale);

}  // namespace espdiff
