// chain_motions.h: how the chains of a molecule turned and shifted against each other.
#pragma once

#include <string>
#include <vector>

#include "base/pairing.h"
#include "base/types.h"

namespace espdiff {

/// Of each chain of the source with at least 20 paired residues, by name: its motion against that of the other such
/// chains together, both by superposition of their paired atoms. Empty with fewer than two such chains. Chains on a
/// line are left out. Time O(n) for each chain.
std::vector<ChainMotion> chain_motions(const Molecule& source, const Molecule& target, const AtomPairing& pairing);

/// "C by 20 degrees and 2.4 A, A by 0.5 degrees and 0.2 A": at most four chains, farthest first.
std::string in_words(std::vector<ChainMotion> motions);

}  // namespace espdiff
