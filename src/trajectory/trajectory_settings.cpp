// trajectory_settings.cpp: the table of a trajectory's own options, and the files of a run.
#include "trajectory/trajectory_settings.h"

#include "base/error.h"
#include "base/message.h"
#include "io/files/check_outputs.h"
#include "prepare/input_files.h"
#include "report/residue_values.h"

namespace espdiff {

const std::vector<OptionRow<TrajectoryRequest>>& trajectory_settings() {
  using Rows = RowsOf<TrajectoryRequest>;
  const char* const group = "Frames";
  static const std::vector<Rows::Row> all{
      Rows::text(
          "frames", group, [](auto& o) -> auto& { return o.frames; },
          "Frames to compare, from 0: all, a frame, begin:end or begin:step:end, or several of these with commas; a "
          "frame may also be first, last (or end), -1 (the last), or in VMD now"),
      Rows::choice_of<std::optional<StartFrom>>(
          "start", group, {{"auto", std::nullopt}, {"previous", StartFrom::kPrevious}, {"source", StartFrom::kSource}},
          [](auto& o) -> auto& { return o.start; },
          "Begin each frame's mapping at the source, or at the previous frame's where that is nearer (by the morph "
          "less than half as far, with at most 0.5 % of the source unmatched on the way): small steps, in less time; "
          "auto: source by the method morph, previous by deform"),
      Rows::file(
          "residues", group, [](auto& o) -> auto& { return o.residues; },
          "CSV file that gets one value of each residue of the source for each frame: a row a frame"),
      Rows::text(
          "residue-quantity", group, [](auto& o) -> auto& { return o.residue_quantity; },
          "Column of the residue table, or of a field's, for the file of residues (mean_abs_difference; without "
          "potentials mean_displacement_A)"),
      Rows::boolean(
          "resume", group, [](auto& o) -> auto& { return o.resume; },
          "Continue where an interrupted run left the file"),
      Rows::boolean(
          "overwrite", group, [](auto& o) -> auto& { return o.overwrite; }, "Replace the file if it exists"),
      Rows::choice_of<bool>(
          "on-error", group, {{"stop", false}, {"skip", true}}, [](auto& o) -> auto& { return o.skip_errors; },
          "skip writes a row with the error in its column `error`, and continues")};
  return all;
}

void check_request(const TrajectoryRequest& request, const CompareOptions& options, std::vector<std::string> inputs,
                   const std::string& picture) {
  if (request.resume && request.overwrite)
    throw InputError(switched_on("resume") + " and " + switched_on("overwrite") + " exclude each other");
  if (!request.residue_quantity.empty()) {
    if (request.residues.empty()) throw InputError(option("residue-quantity") + " needs " + option("residues", "FILE"));
    require_residue_quantity(request.residue_quantity, options.fields);
  }
  for (const std::string& path : input_files(options.input)) inputs.push_back(path);
  check_outputs(inputs, {request.csv, request.csv + ".state", request.residues, picture});
}

std::unique_ptr<TrajectoryRun> begin_trajectory(const TrajectoryRequest& request, TrajectoryPlan plan,
                                                SeriesDescription run) {
  plan.skip_errors = request.skip_errors;
  plan.start = run.start = request.start_of(plan.options);
  run.frames = plan.frames;
  const SeriesHead head = series_head(run, plan.options);
  const ExistingFile existing = request.resume      ? ExistingFile::kResume
                                : request.overwrite ? ExistingFile::kReplace
                                                    : ExistingFile::kRefuse;
  std::optional<ResidueCsv> residues;
  if (!request.residues.empty())
    residues.emplace(request.residues, request.residue_quantity, existing, plan.options.fields);
  SeriesCsv rows(request.csv, head, existing, plan.compared);
  return std::make_unique<TrajectoryRun>(std::move(plan), std::move(rows), std::move(residues));
}

}  // namespace espdiff
