// drift.h: whether a run drifts: goes from one place to another instead of sampling a state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace espdiff {

/// A linear trend in the averages of consecutive blocks of a run.
struct Drift {
  double share =
      0;         ///< of the variance between blocks, over all columns; 1 / (kBlocks - 1) is expected without a trend
  double p = 1;  ///< share of random orders of the blocks whose trend is at least as strong
};

constexpr std::size_t kOrdersOfBlocks = 9999;
constexpr std::uint64_t kSeedOfOrders = 20223;

/// Permutation test of a trend: in a run that samples a state, blocks longer than its memory can stand in any order. A
/// run whose blocks cannot, because it drifts or because it is about as short as its memory, has not sampled a state.
/// Columns are not tested one by one: their trends are summed, with weights, so that there is one p for a run.
/// @param blocks  [column * kBlocks + block] averages; a column with a missing one does not count
/// @param weights [column] such as areas; 0 leaves a column out
/// @returns NaN without a column, and where no block differs
Drift measure_drift(const std::vector<double>& blocks, const std::vector<double>& weights,
                    std::uint64_t seed = kSeedOfOrders);

}  // namespace espdiff
