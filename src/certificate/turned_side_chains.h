// turned_side_chains.h: the atoms of side chains that turned about their bonds between two states.
#pragma once

#include <cstdint>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/types.h"

namespace espdiff {

/// A side chain that turned by more carries another of its faces to the outside. Rotamers lie 120 degrees apart.
constexpr double kLeastTurnDegrees = 50;

/// [source atom] 1 for atoms of side chains whose bonds rotated by more than kLeastTurnDegrees relative to N, CA and C
/// of their residue. The bonds of an atom are those to its paired heavy neighbours in the residue, fitted at both ends
/// (Kabsch); a hydrogen, or the end of a chain, has the bonds of its only neighbour. Half a turn that exchanges equal
/// atoms (Asp, Glu, Phe, Tyr, Arg) does not count. 0 for the backbone, for unpaired atoms, and for residues without N,
/// CA and C in both states: how they turned is not known. Frames of the molecules do not matter.
std::vector<std::uint8_t> turned_atoms(const Molecule& source, const Molecule& target, const AtomPairing& pairing);

}  // namespace espdiff
