// exchanged_side_chains.h: side chains that lie in each other's places.
#pragma once

#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct PairedMolecules;

void check_side_chains(const PairedMolecules& pair, std::vector<Warning>& warnings);

}  // namespace espdiff
