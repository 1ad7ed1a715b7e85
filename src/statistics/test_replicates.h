// test_replicates.h: two groups of replicates compared at each vertex, by the exchange of their labels.
#pragma once

#include <cstddef>
#include <vector>

#include "statistics/surface/surface_test.h"

namespace espdiff {

/// Exchanges the labels of replicates. Statistic: Welch's t of the replicates' means. Its p-values are the shares of
/// permutations whose largest |t| (max-t) or TFCE score on the surface is at least the vertex' own: both control the
/// family-wise error (Nichols & Holmes 2002, Hum. Brain Mapp. 15:1; Winkler et al. 2014, NeuroImage 92:381). `p` and
/// the interval are Welch's, of each vertex alone.
/// @param means   [replicate][vertex], those of the first group first; NaN: not tested
/// @param n_first replicates of the first group; at least 2, as of the second
SurfaceTest test_replicates(const std::vector<std::vector<double>>& means, std::size_t n_first, const MeshGraph& graph,
                            const SurfaceTestOptions& options);

}  // namespace espdiff
