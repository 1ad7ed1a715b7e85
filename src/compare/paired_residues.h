// paired_residues.h: the pairing of residues that follows from paired atoms.
#pragma once

#include <cstdint>
#include <vector>

#include "base/pairing.h"
#include "base/types.h"

namespace espdiff {

/// [source residue] the target residue that shares most atom pairs with it, the first on ties; -1 for none.
std::vector<std::int32_t> paired_residues(const Molecule& source, const Molecule& target, const AtomPairing& pairing);

}  // namespace espdiff
