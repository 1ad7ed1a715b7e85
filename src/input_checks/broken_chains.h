// broken_chains.h: residues that follow each other farther apart than a chain can stretch.
#pragma once

#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct PairedMolecules;

/// Unless both molecules have the gap; as in molecules cut by a periodic cell.
void check_chains(const PairedMolecules& pair, std::vector<Warning>& warnings);

}  // namespace espdiff
