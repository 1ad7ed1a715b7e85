// register_warning.h: residues that lie on the place of others along the chain.
#pragma once

#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct PairedMolecules;

void check_register(const PairedMolecules& pair, const Alignment& alignment, std::vector<Warning>& warnings);

}  // namespace espdiff
