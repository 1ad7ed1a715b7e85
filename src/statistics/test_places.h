// test_places.h: two groups compared over sets of vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "statistics/surface/surface_test.h"

namespace espdiff {

/// Compares area-weighted means over sets of vertices, such as residues or patches, by Welch's test of replicates, or
/// of the blocks of runs.
/// @param means [replicate][vertex], as in test_replicates()
/// @param members [place] vertices; those not tested do not count; a place without one has NaN
PlaceTests test_places(const SurfaceTest& surface, const std::vector<std::vector<double>>& means, std::size_t n_first,
                       const MeshGraph& graph, const std::vector<std::vector<std::uint32_t>>& members,
                       double confidence);

}  // namespace espdiff
