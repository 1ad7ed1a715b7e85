// local_motions.h: a rigid motion for each residue, from its neighbourhood along the chain and in space.
#pragma once

#include "base/molecule/pairing.h"
#include "base/types.h"
#include "motions/domain_motions.h"

namespace espdiff {

/// The motions of `--domains local`, in the common frame. Each residue with paired atoms has the best motion of the
/// residues within 8 places of it in an unbroken chain and of those within 12 A of it at both ends. Neighbours weigh
/// less the farther they are, so that motions change gradually along the chain: a loop or a tail turns about its joint
/// and does not pass straight through the molecule.
///
/// Rotations continue along a chain: of the two ways around to the same end, a residue takes the one closer to that of
/// the residue before it. A rotation may therefore exceed 180 degrees. Chains follow bonds and residue numbers
/// (chain_links()), not the order of the file. Serial; the cost is linear in the number of residues.
DomainMotions local_motions(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                            const RigidTransform& from_source, const RigidTransform& from_target);

}  // namespace espdiff
