// chi_angles.h: the dihedral angles of side chains.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Atoms of the chain of bonds N, CA, CB, ... by one-letter code: angle k, from 1, is about the bond of atoms k and
/// k + 1, counted from 0. Empty for a residue without such angles.
std::vector<std::string> side_chain_bonds(char letter);
/// Whether half a turn about the last bond exchanges equal atoms.
bool is_symmetric_end(char letter);
/// Degrees, -180 to 180 (IUPAC: positive clockwise, seen along the bond b to c).
double dihedral(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

/// The largest turn of a side chain between two states.
struct ChiTurn {
  int chi = 0;       ///< from 1; 0 where no angle is known in both
  double angle = 0;  ///< degrees, 0 to 180; 0 to 90 where half a turn exchanges equal atoms
};

/// The first of the angles that differs by more than `least` degrees, or else the one that differs most. Definitions
/// of IUPAC-IUB (J. Mol. Biol. 52, 1 (1970)).
/// @param source_atoms, target_atoms of the residue, indices into its molecule
ChiTurn chi_turn(const Molecule& source, const std::vector<std::size_t>& source_atoms, const Molecule& target,
                 const std::vector<std::size_t>& target_atoms, double least);

}  // namespace espdiff
