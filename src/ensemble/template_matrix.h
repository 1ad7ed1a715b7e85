// template_matrix.h: every state against every other one through one template: a mapping for each state instead of each
// pair.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/molecule/structure_options.h"
#include "matrix/matrix_run.h"
#include "options/options.h"

namespace espdiff {

/// How many states there may be: results grow with the square of it.
constexpr std::size_t kMostTemplateStates = 2000;

/// How a matrix goes through a template.
struct TemplateRequest {
  std::string text;              ///< medoid, a variant's label, its number from 0, or a structure file
  std::size_t n_exact = 6;       ///< pairs that are compared by themselves as well; see exact_sample()
  CompareOptions options;        ///< of the mappings: ensemble_options()
  StructureOptions structure{};  ///< how a template's file is read
};

/// Maps the template's surface onto each variant, and keeps the potentials in OUT.h5 (an ensemble file, which stays);
/// compares the sampled pairs by themselves, each kept in the state file; writes OUT.csv and OUT.json. Both files make
/// it resumable, and a shard has its part of the states and of the pairs.
/// @param options of the exact pairs
/// @throws InputError (no potentials; a region, which is of a source; a metric to cluster by that a template does not
///         give; more than kMostTemplateStates; no such template), and as run_ensemble() and run_matrix()
MatrixReport run_template_matrix(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                                 const TemplateRequest& request, const MatrixRun& run, const Progress& progress);

/// Whether files are parts of such a matrix: one of them is an ensemble file of it.
bool are_parts_of_template_matrix(const std::vector<std::string>& paths);

/// Merges shards, the same bytes as from one process.
/// @param paths their HDF5 files and state files
/// @throws as merge_ensemble() and merge_matrix()
MatrixReport merge_template_matrix(const std::vector<std::string>& paths, const MatrixRun& run);

}  // namespace espdiff
