// residue_rows.h: the comparison by residue.
#pragma once

#include <cstddef>
#include <vector>

#include "certificate/result.h"

namespace espdiff {

struct MappedSurface;

/// One row per source residue: averages over its trusted area, weighted like the metrics: a third of each triangle at
/// each of its vertices. Potentials are known where a triangle is trusted.
std::vector<ResidueRow> residue_rows(const MappedSurface& surface, const SurfaceAreas& areas, std::size_t n_residues,
                                     bool has_potential);

}  // namespace espdiff
