// paired_residues.h: the pairing of residues that follows from paired atoms.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/molecule/pairing.h"
#include "base/types.h"

namespace espdiff {

/// [source residue] the target residue that shares most atom pairs with it, the first on ties; -1 for none.
std::vector<std::int32_t> paired_residues(const Molecule& source, const Molecule& target, const AtomPairing& pairing);

/// [target residue] the source residue whose partner it is, the last of them; -1 for none.
/// @param target_of from paired_residues()
std::vector<std::int32_t> source_residues(const std::vector<std::int32_t>& target_of, std::size_t n_target_residues);

}  // namespace espdiff
