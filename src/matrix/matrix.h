// matrix.h: every variant compared with every other one, both ways.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "matrix/variants.h"
#include "report/metrics.h"

namespace espdiff {

struct CompareOptions;

/// The metrics that a matrix holds, in the order of files.
const std::vector<Metric>& matrix_metrics();
/// The position of a metric. @throws InputError that lists them
std::size_t find_metric(const std::string& name);

/// One ordered pair: the source's surface mapped onto the target's.
struct MatrixCell {
  std::size_t source = 0, target = 0;  ///< positions among the variants
  std::vector<double> values;          ///< [metric]; NaN where there is none
  bool converged = false, trustworthy = false;
  std::vector<std::string> reasons;  ///< why it is not trustworthy
  std::string error;                 ///< why there are no values
};

using MatrixPair = std::pair<std::size_t, std::size_t>;  ///< source, target

/// A part of the pairs, for several processes: number `index` of `count`, from 1.
struct Shard {
  int index = 1, count = 1;
};
/// Reads "2/8". @throws InputError
Shard parse_shard(const std::string& text);

/// The ordered pairs of n variants without the diagonal, source by source; of a shard a contiguous part of them, so
/// that a source is prepared in one process, or two at its border. The shards' parts differ in size by one at most.
std::vector<MatrixPair> matrix_pairs(std::size_t n_variants, const Shard& shard = {});

/// Compares pairs in the order given. A source's surface is made and regularized once for all pairs that follow
/// each other with it; a target's surface is made anew for each pair, along the axes of the source, as compare() does:
/// a cell holds the same bits as compare() of its pair, in whatever order and part of the matrix it is computed.
/// @param skip_errors a pair that cannot be compared becomes a cell with the error; else its error is thrown, with the
///                    labels of the pair
/// @param done        called with each cell as it is done
/// @param progress    gets "LABEL to LABEL: stage" and the part of `pairs` done
/// @throws as compare()
void compute_pairs(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                   const std::vector<MatrixPair>& pairs, bool skip_errors,
                   const std::function<void(const MatrixCell&)>& done, const Progress& progress);

}  // namespace espdiff
