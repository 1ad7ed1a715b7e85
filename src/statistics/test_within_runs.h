// test_within_runs.h: two single runs compared at each vertex, by the exchange of their blocks of frames.
#pragma once

#include <cstddef>
#include <vector>

#include "statistics/surface/surface_test.h"

namespace espdiff {

/// For a group of one replicate: cuts the runs into blocks, and does with their means what test_replicates() does with
/// those of replicates: Welch's t has its error estimated anew in each permutation. That is exact where blocks can be
/// exchanged. So they are at least twice as long as the statistical inefficiency g, and g frames between them are left
/// out: means of neighbouring blocks of an autoregressive series then have a correlation of 0.02, and 0.17 without the
/// gap. Differences are of all frames; errors, t and p of the blocks. With fewer than four blocks of a run there is no
/// p and no interval (`no_p`).
/// @param tested [vertex] nonzero where values are compared
SurfaceTest test_within_runs(const Columns& columns, const std::vector<ReplicateColumns>& replicates,
                             std::size_t n_first, const std::vector<char>& tested, const MeshGraph& graph,
                             const SurfaceTestOptions& options);

/// The statistical inefficiency that blocks within runs are made for: the ninth decile over the tested vertices, of the
/// run where it is largest; 1 without a value.
double inefficiency_of_runs(const std::vector<ReplicateColumns>& replicates, const std::vector<char>& tested);

}  // namespace espdiff
