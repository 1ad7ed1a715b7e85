// residue_changes.h: what changed about each residue of two states.
#pragma once

#include <cstdint>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/types.h"
#include "causes/causes.h"

namespace espdiff {

/// What is compared.
struct ComparedResidues {
  const Molecule& source;
  const Molecule& target;
  const std::vector<std::int32_t>& target_of;  ///< [source residue] its partner, -1 for none
  const AtomPairing& pairing;
  const std::vector<ProtonationDifference>& protonation;
  RigidTransform source_to_target;  ///< the superposition
};

/// What changed about each residue: those of the source, then the target's others.
std::vector<ResidueChange> residue_changes(const ComparedResidues& compared);

/// Whether the molecule's atoms have B factors that are not all the same.
bool knows_places(const Molecule& molecule);

}  // namespace espdiff
