// paired_residues.h: which residue of the target is which of the source, as the paired atoms say.
#pragma once

#include <cstdint>
#include <vector>

#include "align/pair_atoms.h"

namespace espdiff {

/// [source residue] the target's residue that shares most atom pairs with it, the first of equals; -1 for none.
std::vector<std::int32_t> paired_residues(const Molecule& source, const Molecule& target, const AtomPairing& pairing);

}  // namespace espdiff
