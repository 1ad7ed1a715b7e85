// hydrogen_bonds.h: which atoms give and take hydrogen bonds, by their bonds.
#pragma once

#include <vector>

#include "base/types.h"

namespace espdiff {

/// [atom] 1 for what gives hydrogen bonds: nitrogens and oxygens with a hydrogen (in the same residue, within 1.3 A),
/// and that hydrogen; otherwise 0. Empty if the molecule has no hydrogens.
std::vector<float> donors(const Molecule& molecule);

/// [atom] 1 for what takes hydrogen bonds: oxygens, and nitrogens with at most two neighbours (within 1.9 A), none of
/// them a hydrogen; otherwise 0. Empty if the molecule has no hydrogens.
std::vector<float> acceptors(const Molecule& molecule);

}  // namespace espdiff
