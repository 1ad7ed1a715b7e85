// ensemble_run.h: fills an ensemble file frame by frame; resumes, in shards that merge.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "base/text/option_row.h"
#include "ensemble/frames/ensemble_plan.h"
#include "mapping/input.h"
#include "matrix/matrix.h"

namespace espdiff {

struct CompareOptions;

struct EnsembleRun {
  std::string output;  ///< prefix of OUT.h5 and the results
  Shard shard;
  bool resume = false, overwrite = false;
  bool skip_errors = false;  ///< a frame that cannot be mapped has no values, and the run continues
};

/// The options of these, where `at` finds them in what is asked for; in the order of the manuals.
template <typename Study, typename At>
std::vector<OptionRow<Study>> run_rows(At at) {
  using Rows = RowsOf<Study>;
  const std::string group = "Run";
  return {
      Rows::boolean(
          "resume", group, [at](auto& o) -> auto& { return at(o).resume; },
          "Continue OUT.h5 of an interrupted run; a complete one gets new statistics"),
      Rows::boolean(
          "overwrite", group, [at](auto& o) -> auto& { return at(o).overwrite; }, "Replace OUT.h5 if it exists"),
      Rows::template choice_of<bool>(
          "on-error", group, {{"stop", false}, {"skip", true}}, [at](auto& o) -> auto& { return at(o).skip_errors; },
          "A frame that cannot be mapped stops the run, or has no values"),
      Rows::parsed(
          "shard", group, [at](Study& o, const std::string& text) { at(o).shard = parse_shard(text); },
          [at](const Study& o) { return to_string(at(o).shard); },
          "Map part I of N of the frames, I/N, into OUT.shard-I-of-N.h5; `espdiff merge` merges the parts")};
}

struct EnsembleReport {
  std::string path;                                     ///< of the file
  std::vector<std::string> field_paths;                 ///< [field] of the files of other fields
  std::vector<std::string> notes;                       ///< on fields: what does not match, of the first frame mapped
  std::size_t n_frames = 0;                             ///< of this run's shard
  std::size_t n_resumed = 0;                            ///< of these, there before
  std::size_t n_damaged = 0;                            ///< that were begun or damaged, and computed again
  std::size_t n_skipped = 0;                            ///< with an error instead of values
  double seconds = 0;                                   ///< for the frames that were computed
  std::vector<std::pair<std::string, double>> time_ms;  ///< of the frames computed, by stage
};

/// OUT.FIELD, the prefix of a field's results.
inline std::string field_prefix(const std::string& output_prefix, const std::string& field) {
  return output_prefix + "." + field;
}

/// OUT.h5, or OUT.shard-2-of-8.h5.
std::string ensemble_path(const std::string& output_prefix, const Shard& shard);

/// Maps the template onto every frame of the shard that the file, or that of a field (OUT.FIELD.h5), lacks: several
/// beside each other, each by a thread of the CPU, or a few at a time on a GPU; the same bytes as one by one. The files
/// are complete for these frames when this returns; after an error or a cancellation they have all finished ones.
/// @param plan     all but residues
/// @param source   the template
/// @param read     a frame of all; called on this thread, in their order, while frames before it are mapped
/// @param progress receives "frame 12 of 400, 3 min left; wild, replicate w1, frame 11: morph"
/// @throws InputError (the file exists and neither resume nor overwrite was asked for; it is of another run), and as
///         TemplateMapping; a frame's error names it
EnsembleReport run_ensemble(Engine& engine, EnsemblePlan plan, const CompareInput& source,
                            const CompareOptions& options, const EnsembleRun& run,
                            const std::function<HeldInput(std::size_t)>& read, const Progress& progress);

/// Merges the files of shards into OUT.h5, the same bytes as from one process.
/// @throws InputError (parts of different runs; frames missing; OUT.h5 exists and `overwrite` is not set)
EnsembleReport merge_ensemble(const std::vector<std::string>& paths, const EnsembleRun& run);

}  // namespace espdiff
