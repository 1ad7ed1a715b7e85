// compared_chains.h: which chains were compared with which, and which are copies of each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/types.h"

namespace espdiff {

/// In the order of the source's chains; chains without a paired residue are left out.
/// @param target_of [source residue] its partner, -1 for none
std::vector<ComparedChains> compared_chains(const Molecule& source, const Molecule& target,
                                            const std::vector<std::int32_t>& target_of);

/// Chains that repeat one sequence, such as the copies in an asymmetric unit: of equal letters where both have a
/// residue of one number, which at least nine in ten of the shorter chain's residues have.
/// @returns groups of two or more chain names, in the molecule's order
std::vector<std::vector<std::string>> repeated_chains(const Molecule& molecule);

/// "A with A, B with C"
std::string in_words(const std::vector<ComparedChains>& chains);

}  // namespace espdiff
