// atom_paths.h: the paths of all atoms from source to target, for the morph.
#pragma once

#include <vector>

#include "base/molecule/pairing.h"
#include "base/progress.h"
#include "base/types.h"
#include "engine/morph_stage.h"
#include "motions/domain_motions.h"

namespace espdiff {

/// Paired atoms move to their partner, in a straight line or with the rigid domain of their residue. Unpaired atoms of
/// paired residues, as in a substitution, pair with the nearest unpaired atom of the other residue within 2.5 A,
/// hydrogens with hydrogens only. Any other unpaired atom grows out of, or shrinks into, its *anchor*: the nearest
/// paired atom of its residue, or of the molecule if the residue has none. So a side chain grows from its base instead
/// of appearing in free space. Farther than 8 A from its anchor, an atom fades in or out in place and moves as its
/// anchor does.
/// @param from_source, from_target own frames -> common frame
/// @throws InputError if no atoms pair
std::vector<MovingAtom> atom_paths(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                                   const RigidTransform& from_source, const RigidTransform& from_target,
                                   const DomainMotions& domains, double radius_scale, const Progress& progress = {});

}  // namespace espdiff
