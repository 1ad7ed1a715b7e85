// residue_rows.h: the comparison by residue.
#pragma once

#include <cstddef>
#include <vector>

#include "compare/result.h"

namespace espdiff {

struct MappedSurface;

/// One row per source residue: averages over its valid area, weighted like the metrics.
std::vector<ResidueRow> residue_rows(const MappedSurface& surface, std::size_t n_residues, bool has_potential);

}  // namespace espdiff
