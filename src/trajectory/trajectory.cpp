// trajectory.cpp: the steps of a run over frames, and resuming.
#include "trajectory/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "certificate/result.h"
#include "compare/stages/readings.h"
#include "engine/read_and_compute.h"
#include "io/text/text_cursor.h"
#include "mapping/input.h"
#include "report/residue_values.h"
#include "report/state_report.h"
#include "trajectory/series_file.h"

namespace espdiff {
namespace {

/// Whether a recomputed cell agrees with the existing one, up to the last digits of another back end.
bool same_cell(const std::string& then, const std::string& now) {
  if (then == now) return true;
  double a = 0, b = 0;
  constexpr double kRelative = 1e-4, kAbsolute = 1e-6;
  return parse_number(then, a) && parse_number(now, b) && std::fabs(a - b) <= kRelative * std::fabs(a) + kAbsolute;
}

std::vector<TrajectoryStep> steps_of(const TrajectoryPlan& plan) {
  std::vector<TrajectoryStep> steps;
  std::optional<int> previous;
  for (const int frame : plan.frames) {
    const std::optional<int> source = plan.against == Reference::kSame ? frame : previous;
    if (plan.against == Reference::kOne) {
      steps.push_back({frame, std::nullopt, plan.reference});
    } else if (source) {
      steps.push_back({frame, source, std::to_string(*source)});
    }
    previous = frame;
  }
  if (steps.empty())
    throw InputError(plan.against == Reference::kPrevious
                         ? option("reference", "previous") + " needs two frames or more"
                         : Message("there are no frames to compare"));
  return steps;
}

/// The error of a frame, except a cancellation.
template <typename Work>
std::optional<Error> error_of(Work work) {
  try {
    work();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

/// A row has no place for causes: they go to the table of residues, one reading a file.
void check_causes_of_frames(const CompareOptions& options, const std::string& quantity) {
  if (options.causes.empty()) return;
  if (options.scan) throw InputError(option("scan") + " is of one pair, not of a trajectory");
  if (options.side_chains > 0)
    throw InputError(option("side-chains") + " is of one pair, not of a trajectory, whose frames are its samples");
  if (options.causes.size() > 1)
    throw InputError(option("causes") + ": a trajectory has those of one reading; run it once for each");
  if (quantity != kContribution)
    throw InputError(option("causes") + " of a trajectory are written as a table of residues: give " +
                     option("residues", "FILE") + " and " + option("residue-quantity", kContribution));
}

/// Which names the files of their fields.
void name_frames(const TrajectoryStep& step, StepInput& input) {
  input.target.fields.frame = step.frame;
  input.source.fields.frame = step.source.value_or(-1);
}

std::string in_front(int frame) { return "frame " + std::to_string(frame) + ": "; }

}  // namespace

StartFrom usual_start(const CompareOptions& options) {
  return options.method == Method::kMorph ? StartFrom::kSource : StartFrom::kPrevious;
}

TrajectoryRun::TrajectoryRun(TrajectoryPlan plan, SeriesCsv file, std::optional<ResidueCsv> residues)
    : plan_(std::move(plan)), file_(std::move(file)), residues_(std::move(residues)), steps_(steps_of(plan_)) {
  if (plan_.options.offsets_A.size() > 1)
    throw InputError(option("offset") +
                     ": a list of distances was given, and a trajectory has one row for a frame; give one");
  check_causes_of_frames(plan_.options, residues_ ? residues_->quantity() : std::string());
  check_earlier_rows();
  resume_residues();
  position_ = n_resumed_ = file_.rows().size();
  if (position_ == 0 || is_done()) {
    remove_state();
  } else {
    restore_mapping();
  }
}

TrajectorySummary TrajectoryRun::summary() const {
  const auto& rows = file_.rows();
  const auto n_trusted =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row["trustworthy"] == "1"; });
  return {steps_.size(), rows.size() - n_resumed_, n_skipped_, n_resumed_, static_cast<std::size_t>(n_trusted)};
}

void TrajectoryRun::check_earlier_rows() const {
  const auto& rows = file_.rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool is_beyond = i >= steps_.size();
    if (!is_beyond && rows[i]["frame"] == std::to_string(steps_[i].frame)) continue;
    throw InputError(file_.path() + ": row " + std::to_string(i + 1) + " is of frame " + rows[i]["frame"] + ", " +
                     (is_beyond ? std::string("beyond the run") : "not of " + std::to_string(steps_[i].frame)) + "; " +
                     switched_on("overwrite") + " begins anew");
  }
}

/// The rows of residues are those of the frames with numbers.
void TrajectoryRun::resume_residues() {
  if (!residues_) return;
  std::vector<std::string> frames;
  for (const SeriesRow& row : file_.rows()) {
    if (row["error"].empty()) frames.push_back(row["frame"]);
  }
  residues_->resume(frames, file_.fingerprint());
}

bool TrajectoryRun::keeps_mappings() const {
  return plan_.start == StartFrom::kPrevious && plan_.against == Reference::kOne;
}

void TrajectoryRun::remove_state() const { std::remove(state_path().c_str()); }

std::string TrajectoryRun::state_fingerprint(const std::string& frame) const {
  return "frame " + frame + " " + file_.fingerprint();
}

SeriesState TrajectoryRun::read_mapping_of(const SeriesRow& row) const {
  return read_series_state(state_path(), state_fingerprint(row["frame"]));
}

void TrajectoryRun::restore_mapping() {
  const auto& rows = file_.rows();
  if (!keeps_mappings() || !rows.back().has_mapping()) return;
  std::string reason;
  try {
    restored_ = read_mapping_of(rows.back());
    return;
  } catch (const Error& error) {
    reason = error.what();
  }
  // If the run was interrupted between a row and its mapping, the last row is computed again: from the source, or from
  // the mapping of the row before, to which the state belongs.
  if (rows.back()["start"] == "source") {
    --position_;
    return;
  }
  try {
    if (rows.size() < 2 || !rows[rows.size() - 2].has_mapping()) throw InputError("there is no mapping before it");
    restored_ = read_mapping_of(rows[rows.size() - 2]);
    --position_;
  } catch (const Error&) {
    warning_ =
        "the mapping of frame " + rows.back()["frame"] + " is missing, the next one starts from the source: " + reason;
  }
}

void TrajectoryRun::note_inputs(const std::vector<InputFile>& inputs) {
  std::vector<std::pair<std::string, std::string>> by_role;  // a role may have several files, such as ligands
  for (const InputFile& input : inputs) {
    const std::string name = input.role + "_sha256";
    const auto same = std::find_if(by_role.begin(), by_role.end(), [&](const auto& one) { return one.first == name; });
    if (same != by_role.end()) {
      same->second += "; " + input.sha256;
    } else {
      by_role.emplace_back(name, input.sha256);
    }
  }
  for (const auto& [name, sha256] : by_role) file_.note(name, sha256);
}

Error TrajectoryRun::cancelled() const {
  return {ErrorClass::kCancelled, "cancelled after " + std::to_string(file_.rows().size()) + " of " +
                                      std::to_string(steps_.size()) + " rows; " + switched_on("resume") +
                                      " continues " + file_.path()};
}

const SeriesRow* TrajectoryRun::step(Engine& engine, const std::function<StepInput()>& read, const Progress& progress) {
  // Progress of the whole run; each stage of a frame starts at 0.
  const Progress inner([&](const std::string& stage, double fraction) {
    share_ = std::max(share_, (static_cast<double>(position_) + fraction) / static_cast<double>(steps_.size()));
    progress.report(in_front(next().frame) + stage, share_);
  });
  try {
    StepInput input;
    const auto unread = error_of([&] {
      inner.report("read", 0.0);
      input = read();
    });
    if (unread) return skip(*unread);
    note_inputs(input.inputs);
    file_.require_all_noted();
    std::optional<SeriesRow> row;
    const auto failed = error_of([&] { row = compare(engine, input, inner); });
    return failed ? skip(*failed) : end_step(*row);
  } catch (const Cancelled&) {
    throw cancelled();
  }
}

const SeriesRow* TrajectoryRun::skip(const Error& why) {
  const TrajectoryStep& step = next();
  if (!plan_.skip_errors) throw Error(why.error_class(), in_front(step.frame) + why.message());
  ++n_skipped_;
  return end_step({step.frame, step.reference, why.what(), plan_.compared});
}

/// After a failed frame the mapping starts from the source, as in a run that is resumed there.
StartFrom TrajectoryRun::start_of_step() const {
  const bool follows_error = position_ > 0 && !file_.rows()[position_ - 1]["error"].empty();
  return follows_error || plan_.against != Reference::kOne ? StartFrom::kSource : plan_.start;
}

SeriesRow TrajectoryRun::compare(Engine& engine, StepInput input, const Progress& progress) {
  name_frames(next(), input);
  if (series_ == nullptr || plan_.against != Reference::kOne)
    series_ = std::make_unique<Series>(engine, input.source, plan_.options);
  if (restored_) series_->restore(std::move(*restored_));
  restored_.reset();
  Compared frame = compared(next(), std::move(input), *series_, start_of_step(), progress);
  add_residues(frame);
  return std::move(frame.row);
}

TrajectoryRun::Compared TrajectoryRun::compared(const TrajectoryStep& step, StepInput input, Series& series,
                                                StartFrom start, const Progress& progress) const {
  CompareResult result = series.step(input.target, start, progress);
  if (input.source_origin != nullptr) note_states(result, *input.source_origin, *input.target_origin, {});
  SeriesRow row(step.frame, step.reference, *input.source.molecule, *input.target.molecule, result, plan_.options);
  std::shared_ptr<const CompareResult> kept;
  if (residues_) kept = std::make_shared<const CompareResult>(std::move(result));
  return {std::move(row), std::move(input), std::move(kept)};
}

void TrajectoryRun::add_residues(const Compared& frame) {
  residue_line_.reset();
  if (residues_)
    residue_line_ =
        residues_->row(next().frame, *frame.input.source.molecule, *frame.input.target.molecule, *frame.result);
}

bool TrajectoryRun::is_independent() const {
  return plan_.against == Reference::kOne && plan_.start == StartFrom::kSource;
}

void TrajectoryRun::finish(Engine& engine, std::size_t n_atoms,
                           const std::function<StepInput(const TrajectoryStep&)>& read, const Progress& progress) {
  const std::size_t first = position_, n = steps_.size() - first;
  const Progress inner([&](const std::string& stage, double) {
    if (is_done()) return;
    share_ = std::max(share_, static_cast<double>(position_) / static_cast<double>(steps_.size()));
    progress.report(in_front(next().frame) + (stage.empty() ? "read" : stage), share_);
  });
  // The head names the inputs of the frames up to a row, as one after the other: what is read ahead waits.
  std::vector<std::optional<std::vector<InputFile>>> inputs(n);
  const auto note = [&](std::size_t i) {
    const auto of_frame = std::exchange(inputs[i], std::nullopt);
    if (!of_frame) return;  // it could not be read
    note_inputs(*of_frame);
    file_.require_all_noted();
  };
  const auto read_step = [&](std::size_t i) {
    StepInput input = read(steps_[first + i]);
    inputs[i] = std::move(input.inputs);
    name_frames(steps_[first + i], input);
    return input;
  };
  const auto begin = [&](Engine& of_worker) -> ItemSteps<StepInput, Compared>::Compute {
    const auto series = std::make_shared<std::unique_ptr<Series>>();
    return [&, series](std::size_t i, const StepInput& input, const Progress& stages) {
      if (*series == nullptr) *series = std::make_unique<Series>(of_worker, input.source, plan_.options);
      return compared(steps_[first + i], input, **series, StartFrom::kSource, stages);
    };
  };
  const auto done = [&](std::size_t i, const Compared& frame) {
    note(i);
    const auto unlike = error_of([&] { add_residues(frame); });
    unlike ? skip(*unlike) : end_step(frame.row);
  };
  const auto failed = [&](std::size_t i, const Error& error) {
    note(i);
    skip(error);
  };
  try {
    inner.report("read", 0.0);
    read_and_compute<StepInput, Compared>(engine, workers_for_frames(engine, n, n_atoms, 0), n,
                                          {read_step, begin, done, failed}, inner);
  } catch (const Cancelled&) {
    throw cancelled();
  }
}

/// Writes the row first, then its mapping, both before the next step.
const SeriesRow* TrajectoryRun::end_step(const SeriesRow& row) {
  const bool is_there = position_ < file_.rows().size(), is_last = position_ + 1 == steps_.size();
  if (is_there) {
    compare_again(row);
  } else {
    // First, since the frame's own row says that it is done.
    if (residue_line_) residues_->add(*residue_line_, file_.fingerprint());
    residue_line_.reset();
    file_.add(row);
  }
  const auto state =
      keeps_mappings() && !is_last && row["error"].empty() ? series_->state() : std::optional<SeriesState>();
  if (state) write_series_state(state_path(), *state, state_fingerprint(row["frame"]));
  ++position_;
  if (is_last) {
    remove_state();
    series_.reset();
  }
  return is_there ? nullptr : &file_.rows().back();
}

/// A recomputed row must equal the existing one; otherwise the inputs have changed.
void TrajectoryRun::compare_again(const SeriesRow& row) const {
  const SeriesRow& earlier = file_.rows()[position_];
  for (const char* column : {"rmsd_A", "mean_displacement_A", "mean_abs_difference"}) {
    if (same_cell(earlier[column], row[column])) continue;
    throw InputError("frame " + row["frame"] + " now has " + column + " '" + row[column] + "' instead of '" +
                     earlier[column] + "' in " + file_.path() + ": its input has changed; " + switched_on("overwrite") +
                     " begins anew");
  }
}

}  // namespace espdiff
