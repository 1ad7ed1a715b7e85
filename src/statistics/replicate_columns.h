// replicate_columns.h: each replicate's columns in numbers: means, inefficiencies, halves.
#pragma once

#include <cstddef>
#include <vector>

#include "statistics/autocorrelation.h"

namespace espdiff {

class Columns;

/// A replicate's columns. [column]
struct ReplicateColumns {
  std::size_t n_frames = 0;
  std::vector<SeriesSummary> columns;
  std::vector<double> first_half, second_half;  ///< means; NaN without a value
  /// [column * kBlocks + block] means of consecutive blocks, a remainder at the start left out; NaN without a value,
  /// and all where there are fewer frames than blocks
  std::vector<double> blocks;
};

/// Summarizes every column of every replicate. Reads kColumnBytes at a time: memory does not grow with the number of
/// frames, only the number of passes does. The same bits at any number of threads.
std::vector<ReplicateColumns> summarize_columns(const Columns& columns);

}  // namespace espdiff
