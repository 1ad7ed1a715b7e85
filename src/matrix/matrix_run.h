// matrix_run.h: a matrix from variants to files: computed, saved as it grows, resumed, and merged from parts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "matrix/matrix_summary.h"

namespace espdiff {

struct MatrixRun {
  std::string output;  ///< prefix of OUT.csv, OUT.json and the state file
  Shard shard;
  bool resume = false;       ///< continue from the state file, if there is one
  bool overwrite = false;    ///< start again and replace results and state files
  bool skip_errors = false;  ///< see compute_pairs()
  std::string potential;     ///< description, for the results
  std::string radii_note;    ///< where radii are replaced, for the results; may be empty
  std::string cluster_by;    ///< a metric; empty: usual_metric()
  /// Further files that no output may replace, such as a list.
  std::vector<std::string> read_files{};
  bool through_template = false;  ///< keeps OUT.h5 as well
};

/// The parts of a run through a template; see run_template_matrix().
struct TemplateWork {
  std::size_t n_states = 0, n_states_resumed = 0;  ///< mapped, of this run's shard
  std::size_t n_exact = 0, n_exact_resumed = 0;    ///< pairs compared by themselves
  double seconds = 0, exact_seconds = 0;           ///< for those that were computed
};

struct MatrixReport {
  std::size_t n_pairs = 0;         ///< of this run's shard
  std::size_t n_resumed = 0;       ///< of these, computed before
  bool cut_off = false;            ///< the state file's last row was incomplete and was computed again
  double seconds = 0;              ///< for the pairs that were computed
  std::optional<Matrix> matrix;    ///< complete; absent for a shard
  std::vector<std::string> files;  ///< written
  std::optional<TemplateWork> template_work{};
};

/// All that a run writes: results, or a shard's state file.
std::vector<std::string> output_paths(const MatrixRun& run);

/// check_outputs() of a run. @param variants as far as they are known
void check_matrix_files(const MatrixRun& run, const std::vector<Variant>& variants);

/// OUT.ENDING, or OUT.shard-2-of-8.ENDING.
std::string part_path(const std::string& output_prefix, const Shard& shard, const std::string& ending);

/// OUT.state, or OUT.shard-2-of-8.state.
std::string state_path(const std::string& output_prefix, const Shard& shard);

/// Refuses to replace results that are there. @param may_replace whether they may be replaced. @throws InputError
void check_results(const MatrixRun& run, bool may_replace, const PartsAndFields& compared);

/// Refuses a run that would replace results or state files, before the work.
/// @param has_parts whether there is something that `resume` continues
/// @throws InputError
void check_existing(const MatrixRun& run, bool has_parts, const PartsAndFields& compared);

/// Computes those of `pairs` that the state file lacks, and keeps each there. `report` gets what was done.
/// @returns all of them. @throws as run_matrix()
std::vector<MatrixCell> compute_and_keep(Engine& engine, const std::vector<Variant>& variants,
                                         const CompareOptions& options, const MatrixRun& run, const MatrixPlan& plan,
                                         const std::vector<MatrixPair>& pairs, const Progress& progress,
                                         MatrixReport& report);

/// Writes the results of a whole matrix.
void finish_matrix(const MatrixRun& run, Matrix matrix, MatrixReport& report);

/// Computes the shard's pairs that the state file lacks and writes each into it. Then, for a whole matrix, writes the
/// results (write_matrix()) and removes the state file. A shard's state file stays for merge_matrix(). After an error
/// or a cancellation the state file has all finished cells.
/// @param progress receives "pair 12 of 342, 3 min left; LABEL to LABEL: stage"
/// @throws InputError (both resume and overwrite; results or state files exist and neither was asked for; as
///         make_plan(), MatrixState), and as compute_pairs()
MatrixReport run_matrix(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                        const MatrixRun& run, const Progress& progress);

/// The metric that `run` clusters by. @throws InputError as find_metric()
std::size_t metric_to_cluster_by(const MatrixRun& run, const Matrix& matrix);

/// Merges the shards' state files and writes the results, the same bytes as from one process.
/// @throws InputError (parts of different runs, pairs missing, results exist and `overwrite` is not set), and as
///         read_matrix_state()
MatrixReport merge_matrix(const std::vector<std::string>& state_paths, const MatrixRun& run);

/// "45 s", "3 min", "1 h 20 min".
std::string in_words(double seconds);

}  // namespace espdiff
