// matrix_run.cpp: remaining pairs, the state file beside the results, and merging.
#include "matrix/matrix_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include "base/error.h"
#include "compare/stages/readings.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "matrix/matrix_state.h"
#include "matrix/write_matrix.h"
#include "options/cause_settings.h"
#include "options/options.h"
#include "options/settings.h"

namespace espdiff {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::vector<MatrixPair> missing_pairs(const std::vector<MatrixPair>& pairs, const std::vector<MatrixCell>& cells) {
  std::set<MatrixPair> done;
  for (const MatrixCell& cell : cells) done.emplace(cell.source, cell.target);
  std::vector<MatrixPair> missing;
  for (const MatrixPair& pair : pairs) {
    if (done.count(pair) == 0) missing.push_back(pair);
  }
  return missing;
}

/// "a.state and 3 more files"
std::string named(const std::vector<std::string>& paths) {
  if (paths.size() == 1) return paths.front();
  return paths.front() + " and " + std::to_string(paths.size() - 1) +
         (paths.size() == 2 ? " more file" : " more files");
}

}  // namespace

std::string in_words(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::max(0.0, seconds)));
  if (whole < 90) return std::to_string(whole) + " s";
  const long minutes = (whole + 30) / 60;
  if (minutes < 90) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

std::string part_path(const std::string& output_prefix, const Shard& shard, const std::string& ending) {
  if (shard.count == 1) return output_prefix + ending;
  return output_prefix + ".shard-" + std::to_string(shard.index) + "-of-" + std::to_string(shard.count) + ending;
}

std::string state_path(const std::string& output_prefix, const Shard& shard) {
  return part_path(output_prefix, shard, ".state");
}

std::vector<std::string> output_paths(const MatrixRun& run) {
  std::vector<std::string> paths = {state_path(run.output, run.shard)};
  if (run.through_template) paths.push_back(part_path(run.output, run.shard, ".h5"));
  if (run.shard.count == 1) paths.insert(paths.end(), {run.output + ".csv", run.output + ".json"});
  return paths;
}

void check_matrix_files(const MatrixRun& run, const std::vector<Variant>& variants) {
  std::vector<std::string> inputs = input_paths(variants);
  inputs.insert(inputs.end(), run.read_files.begin(), run.read_files.end());
  check_outputs(inputs, output_paths(run));
}

void check_results(const MatrixRun& run, bool may_replace, const PartsAndFields& compared) {
  if (!run.cluster_by.empty()) find_metric(run.cluster_by, compared);
  for (const char* ending : {".csv", ".json"}) {
    if (!may_replace && fs::exists(run.output + ending))
      throw InputError("the result " + run.output + ending + " exists, of a run that is complete; " +
                       switched_on("overwrite") + " replaces it");
    AtomicFile probe(run.output + ending);
  }
}

void check_existing(const MatrixRun& run, bool has_parts, const PartsAndFields& compared) {
  if (run.resume && run.overwrite)
    throw InputError(option("resume") + " and " + option("overwrite") + " exclude each other; leave one out");
  const std::string state = state_path(run.output, run.shard);
  if (!run.overwrite && !run.resume && fs::exists(state)) {
    read_matrix_state(state);  // what cannot be continued is refused with its own remedy
    throw InputError("the state file " + state + " of an earlier run exists; " + switched_on("resume") +
                     " continues it, " + switched_on("overwrite") + " begins anew");
  }
  // A shard's results come with the merge.
  if (run.shard.count == 1) check_results(run, run.overwrite || (run.resume && has_parts), compared);
}

void finish_matrix(const MatrixRun& run, Matrix matrix, MatrixReport& report) {
  report.files = write_matrix(run.output, matrix, metric_to_cluster_by(run, matrix));
  report.matrix = std::move(matrix);
}

std::vector<MatrixCell> compute_and_keep(Engine& engine, const std::vector<Variant>& variants,
                                         const CompareOptions& options, const MatrixRun& run, const MatrixPlan& plan,
                                         const std::vector<MatrixPair>& pairs, const Progress& progress,
                                         MatrixReport& report) {
  const std::string path = state_path(run.output, run.shard);
  MatrixStateContent earlier;
  MatrixState state =
      run.resume && fs::exists(path) ? MatrixState::go_on(path, plan, earlier) : MatrixState::begin(path, plan);
  const std::vector<MatrixPair> missing = missing_pairs(pairs, earlier.cells);
  report.n_pairs = pairs.size();
  report.n_resumed = pairs.size() - missing.size();
  report.cut_off = earlier.cut_off;

  std::vector<MatrixCell> cells = std::move(earlier.cells);
  std::size_t n_done = 0;
  const Clock::time_point start = Clock::now();
  const auto left = [&] {
    if (n_done == 0) return std::string();
    const double each = seconds_since(start) / static_cast<double>(n_done);
    return ", " + in_words(each * static_cast<double>(missing.size() - n_done)) + " left";
  };
  const Progress counted([&](const std::string& stage, double) {
    const std::size_t number = std::min(report.n_resumed + n_done + 1, pairs.size());
    progress.report("pair " + std::to_string(number) + " of " + std::to_string(pairs.size()) + left() + "; " + stage,
                    static_cast<double>(report.n_resumed + n_done) / static_cast<double>(pairs.size()));
  });
  const auto keep = [&](const MatrixCell& cell) {
    state.add(cell);
    cells.push_back(cell);
    ++n_done;
  };
  try {
    compute_pairs(engine, variants, options, missing, run.skip_errors, keep, counted);
  } catch (const Cancelled&) {
    throw Error(ErrorClass::kCancelled, "cancelled after " + std::to_string(report.n_resumed + n_done) + " of " +
                                            std::to_string(pairs.size()) + " pairs, which " + path + " holds; " +
                                            switched_on("resume") + " continues");
  }
  report.seconds = seconds_since(start);
  return cells;
}

MatrixReport run_matrix(Engine& engine, const std::vector<Variant>& variants, const CompareOptions& options,
                        const MatrixRun& run, const Progress& progress) {
  check_matrix_files(run, variants);
  check_existing(run, fs::exists(state_path(run.output, run.shard)), parts_and_fields(options));
  if (options.offsets_A.size() > 1)
    throw InputError(option("offset") +
                     ": a list of distances was given, and a matrix has one value of a metric for a pair; give one");
  refuse_causes(options, "a matrix");
  const MatrixPlan plan = make_plan(engine, variants, options, run.potential, run.radii_note);
  MatrixReport report;
  const std::vector<MatrixCell> cells = compute_and_keep(engine, variants, options, run, plan,
                                                         matrix_pairs(variants.size(), run.shard), progress, report);
  const std::string path = state_path(run.output, run.shard);
  if (run.shard.count > 1) {
    report.files = {path};
    return report;
  }
  finish_matrix(run, assemble(plan, cells, path, "resume the run"), report);
  std::error_code ignored;
  fs::remove(path, ignored);
  return report;
}

std::size_t metric_to_cluster_by(const MatrixRun& run, const Matrix& matrix) {
  return run.cluster_by.empty() ? usual_metric(matrix) : find_metric(run.cluster_by, matrix.plan.compared());
}

MatrixReport merge_matrix(const std::vector<std::string>& state_paths, const MatrixRun& run) {
  check_outputs(state_paths, {run.output + ".csv", run.output + ".json"});
  if (state_paths.empty())
    throw InputError("no state files were given; a run with " + option("shard") + " writes them");
  MatrixPlan plan;
  std::vector<MatrixCell> cells;
  for (const std::string& path : state_paths) {
    MatrixStateContent part = read_matrix_state(path);
    if (cells.empty() && plan.variants.empty()) plan = part.plan;
    const std::string difference = plan_difference(part.plan, plan);
    if (!difference.empty())
      throw InputError(path + ": this is a part of another matrix than " + state_paths.front() + ": " + difference);
    cells.insert(cells.end(), part.cells.begin(), part.cells.end());
  }
  check_results(run, run.overwrite, plan.compared());
  MatrixReport report;
  report.n_pairs = report.n_resumed = cells.size();
  finish_matrix(
      run, assemble(plan, cells, named(state_paths), "resume the shard that lacks them, or name its state file too"),
      report);
  return report;
}

}  // namespace espdiff
