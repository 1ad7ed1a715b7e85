// chain_motions.h: how the chains of a molecule turned and shifted against each other.
#pragma once

#include <string>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/types.h"

namespace espdiff {

/// Of each chain of the source with at least 20 paired residues, by name: its motion against the chains that keep their
/// arrangement, by superposition of the paired atoms. Those are the largest group of chains that the motion of one of
/// them fits by 1 A, or by 1.5 times their own RMSD. Empty with fewer than two chains; chains on a line are left out.
/// Time O(n m) for n atoms in m chains.
std::vector<ChainMotion> chain_motions(const Molecule& source, const Molecule& target, const AtomPairing& pairing);

/// "C by 20.0 degrees and 2.4 A, A by 0.5 degrees and 0.2 A": at most four chains, farthest first.
std::string in_words(std::vector<ChainMotion> motions);

}  // namespace espdiff
