// matrix.h: every variant compared with every other one, in both directions.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "matrix/variants.h"
#include "report/records/metrics.h"

namespace espdiff {

struct CompareOptions;

/// The metrics of a matrix, in the order of files. Those of a region and of patches follow all others, then those of
/// fields.
const std::vector<Metric>& matrix_metrics(const PartsAndFields& compared = {});
/// The position of a metric. @throws InputError listing them
std::size_t find_metric(const std::string& name, const PartsAndFields& compared = {});

/// One ordered pair: the source's surface mapped onto the target's.
struct MatrixCell {
  std::size_t source = 0, target = 0;  ///< indices of variants
  std::vector<double> values;          ///< [metric]; NaN if there is none
  bool converged = false, trustworthy = false;
  std::vector<std::uint8_t> parts_trustworthy{};  ///< [part] 1 or 0
  std::vector<std::string> reasons;               ///< why it is not trustworthy
  std::vector<std::string> warnings;              ///< what else the comparison says of its inputs
  std::string error;                              ///< why there are no values
};

/// Where files say whether a part of a pair is trustworthy.
inline std::string trustworthy_column(const std::string& part) { return part + "_trustworthy"; }

using MatrixPair = std::pair<std::size_t, std::size_t>;  ///< source, target

/// A part of the pairs, for several processes: number `index` of `count`, from 1.
struct Shard {
  int index = 1, count = 1;
};
/// Reads "2/8". @throws InputError
Shard parse_shard(const std::string& text);
std::string to_string(const Shard& shard);

/// The ordered pairs of n variants without the diagonal, source by source. A shard is a contiguous part of them, so
/// that one process, or two at a shard's border, prepares each source. Shards differ in size by at most one.
std::vector<MatrixPair> matrix_pairs(std::size_t n_variants, const Shard& shard = {});

/// Compares pairs, several at a time by threads of their own (workers_for()). A source's surface is made and
/// regularized once for consecutive pairs of a thread. A target's surface is made again for each pair, along the axes
/// of the source, as in compare(). By RadiiChoice::kAuto a pair whose radii are of different kinds takes Bondi's on
/// both sides, whatever the others have: a cell has the same bits as compare() of its pair, in any order and part of
/// the matrix.
/// @param skip_errors a pair that cannot be compared becomes a cell with the error; otherwise its error is thrown, with
/// the labels of the pair
/// @param done        called with each finished cell, in the given order, on this thread
/// @param progress    receives "LABEL to LABEL: stage" and the fraction of `pairs` done
/// @throws as compare()
void compute_pairs(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                   const std::vector<MatrixPair>& pairs, bool skip_errors,
                   const std::function<void(const MatrixCell&)>& done, const Progress& progress);

}  // namespace espdiff
