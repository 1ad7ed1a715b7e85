// geometry_warnings.h: coordinates of one molecule that cannot be right.
#pragma once

#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct ResidueView;

/// The coordinates of one molecule: their unit, rounding, bonds within residues, side chains
/// that are missing throughout, and residues that lie on each other. Refuses what is systematic.
void check_geometry(const char* role, const ResidueView& view, std::vector<Warning>& warnings);

}  // namespace espdiff
