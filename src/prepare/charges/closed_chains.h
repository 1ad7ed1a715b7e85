// closed_chains.h: chains without ends, such as cyclic peptides. PDB2PQR gives every chain two, with their charges and
// atoms, so it sees such a chain twice, open at two places, and each residue is taken from where it is no end.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Residues of a chain whose last one is bound to its first, in the order of the file.
using ClosedChain = std::vector<std::size_t>;

/// Those of at least four residues. A shorter one has no place that is far from both openings.
std::vector<ClosedChain> closed_chains(const Molecule& molecule);

/// [place] residues, with each closed chain from its middle on.
std::vector<std::size_t> from_the_middle(const std::vector<ClosedChain>& chains, std::size_t n_residues);

/// The molecule with its residues in another order. Atoms stay where they are.
Molecule in_order(const Molecule& molecule, const std::vector<std::size_t>& order);

/// The prepared molecule with residues around the ends of closed chains from `other`, where these are inner ones.
/// @param before whose residues the chains name
Molecule without_ends(const Molecule& prepared, const Molecule& other, const Molecule& before,
                      const std::vector<ClosedChain>& chains);

}  // namespace espdiff
