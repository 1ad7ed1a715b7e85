// turned_side_chains.h: the atoms of side chains that turned about their bonds between two states, and of residues that
// turned as a whole.
#pragma once

#include <cstdint>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/types.h"

namespace espdiff {

/// What turned by more carries another of its faces to the outside. Rotamers lie 120 degrees apart.
constexpr double kLeastTurnDegrees = 50;

/// A point farther from where its turned side chain carried it lies beyond the side chain's reach: CA and NH2 of an
/// arginine are 7.3 A apart.
constexpr double kFarTurn_A = 8;

/// What turned. The numbers stand in OUT.vtp (`turned`), at vertices farther than kLargeSlip_A from where it carried
/// them.
enum class Turn : std::uint8_t {
  kNone = 0,
  kSideChain = 1,    ///< the side chain, about its bonds, against N, CA and C of its residue
  kResidue = 2,      ///< these three, or a ligand, against the residues within 13 A: modelled otherwise
  kFarSideChain = 3  ///< kSideChain at vertices farther than kFarTurn_A from where it carried them
};

struct TurnedAtom {
  Turn turn = Turn::kNone;
  RigidTransform carried{};  ///< where the atom carried what is bound to it: the source's own frame to the target's
};

/// [source atom] what turned by more than kLeastTurnDegrees, kFarSideChain never. The bonds of an atom are those to its
/// paired heavy neighbours in the residue, fitted at both ends (Kabsch); a hydrogen, or the end of a chain, has the
/// bonds of its only neighbour. Half a turn that exchanges equal atoms (Asp, Glu, Phe, Tyr, Arg) does not count.
/// Surroundings are the CA within 13 A of a residue's CA, or of the middle of a ligand's heavy atoms (at least four),
/// in both states; at least six. A ligand that lies within 1 A of the same elements under other names did not turn.
/// kNone for unpaired atoms, and where N, CA or C of a residue is missing. Frames of the molecules do not matter. Time:
/// quadratic in the residues, below 0.05 s for 2000.
std::vector<TurnedAtom> turned_atoms(const Molecule& source, const Molecule& target, const AtomPairing& pairing);

}  // namespace espdiff
