// matrix_run.h: a matrix from variants to files: computed, kept on disk as it grows, gone on with, and merged from
// parts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/matrix_summary.h"

namespace espdiff {

struct MatrixRun {
  std::string output;  ///< prefix of OUT.csv, OUT.json and the state file
  Shard shard;
  bool resume = false;       ///< go on with the state file, if there is one
  bool overwrite = false;    ///< begin anew in the place of results and state files
  bool skip_errors = false;  ///< see compute_pairs()
  std::string potential;     ///< in words, for the results
  std::string cluster_by;    ///< a metric; empty: usual_metric()
};

struct MatrixReport {
  std::size_t n_pairs = 0;         ///< of this run's shard
  std::size_t n_resumed = 0;       ///< of these, computed before
  bool cut_off = false;            ///< the state file's last row was incomplete and was computed again
  double seconds = 0;              ///< for the pairs that were computed
  std::optional<Matrix> matrix;    ///< whole; absent of a shard
  std::vector<std::string> files;  ///< written
};

/// All that a run writes: results, or a shard's state file.
std::vector<std::string> output_paths(const MatrixRun& run);

/// OUT.state, or OUT.shard-2-of-8.state.
std::string state_path(const std::string& output_prefix, const Shard& shard);

/// Computes the pairs of the shard that the state file lacks, writing each into it; then, of a whole matrix, writes the
/// results (write_matrix()) and removes the state file. The state file of a shard stays: merge_matrix() takes it.
/// After an error or a cancellation the state file holds what was done.
/// @param progress gets "pair 12 of 342, 3 min left; LABEL to LABEL: stage"
/// @throws InputError (both resume and overwrite; results or state files exist and neither was asked for; as
///         make_plan(), MatrixState), and as compute_pairs()
MatrixReport run_matrix(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                        const MatrixRun& run, const Progress& progress);

/// What `run` asks to cluster by. @throws InputError as find_metric()
std::size_t metric_to_cluster_by(const MatrixRun& run, const Matrix& matrix);

/// Puts the shards' state files together and writes the results, the same bytes as of one process.
/// @throws InputError (parts of different runs, pairs missing, results exist and `overwrite` is not set), and as
///         read_matrix_state()
MatrixReport merge_matrix(const std::vector<std::string>& state_paths, const MatrixRun& run);

/// "45 s", "3 min", "1 h 20 min".
std::string in_words(double seconds);

}  // namespace espdiff
