// alignment.h: how two molecules were paired and superposed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/molecule/rigid_domain.h"
#include "base/types.h"

namespace espdiff {

/// Pairs of atoms, the superposition by them, and the rigid domains.
struct Alignment {
  double rmsd_A = 0;
  AtomPairing pairing;
  /// Of chains with at least 20 paired residues, by name; empty unless there are two.
  std::vector<ChainMotion> chain_motions;
  std::size_t n_superposed_atoms = 0;
  RigidTransform source_to_target;   ///< the superposition
  std::vector<RigidDomain> domains;  ///< superposed separately; displacements start where their motions end
};

}  // namespace espdiff
