// trajectory.cpp: the steps of a run over frames, and how an interrupted one goes on.
#include "trajectory/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "base/error.h"
#include "io/text_cursor.h"
#include "trajectory/series_file.h"

namespace espdiff {
namespace {

/// Whether a cell of a row that was computed again is what it was; another back end's last digits may differ.
bool same_cell(const std::string& then, const std::string& now) {
  if (then == now) return true;
  double a = 0, b = 0;
  constexpr double kRelative = 1e-4, kAbsolute = 1e-6;
  return parse_number(then, a) && parse_number(now, b) && std::fabs(a - b) <= kRelative * std::fabs(a) + kAbsolute;
}

class Run {
 public:
  Run(Engine& engine, const Trajectory& run, SeriesCsv& file, const Progress& progress)
      : run_(run), file_(file), outer_(progress), series_(engine, run.source, run.options) {}

  TrajectorySummary go(const std::function<void(const std::string&)>& warn) {
    if (run_.options.offsets_A.size() > 1)
      throw InputError(option("offset") +
                       ": a list of distances was given, and a trajectory has one row for a frame; give one");
    summary_.n_frames = run_.frames.size();
    summary_.n_resumed = file_.rows().size();
    check_earlier_rows();
    position_ = file_.rows().size();
    if (position_ == 0) remove_state();
    if (position_ > 0 && position_ < run_.frames.size()) restore_mapping(warn);
    for (; position_ < run_.frames.size(); ++position_) step();
    remove_state();
    return summary_;
  }

 private:
  std::string state_path() const { return file_.path() + ".state"; }
  void remove_state() const { std::remove(state_path().c_str()); }
  std::string state_fingerprint(const std::string& frame) const { return "frame " + frame + " " + file_.fingerprint(); }

  bool saves_mappings() const { return run_.start == StartFrom::kPrevious; }

  void check_earlier_rows() const {
    const auto& rows = file_.rows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool is_beyond = i >= run_.frames.size();
      if (!is_beyond && rows[i]["frame"] == std::to_string(run_.frames[i])) continue;
      throw InputError(file_.path() + ": row " + std::to_string(i + 1) + " is of frame " + rows[i]["frame"] + ", " +
                       (is_beyond ? std::string("beyond the run") : "not of " + std::to_string(run_.frames[i])) + "; " +
                       switched_on("overwrite") + " begins anew");
    }
  }

  void restore_mapping_of(const SeriesRow& row) {
    series_.restore(read_series_state(state_path(), state_fingerprint(row["frame"])));
  }

  void restore_mapping(const std::function<void(const std::string&)>& warn) {
    const auto& rows = file_.rows();
    if (!saves_mappings() || !rows.back().has_mapping()) return;
    std::string reason;
    try {
      return restore_mapping_of(rows.back());
    } catch (const Error& error) {
      reason = error.what();
    }
    // Interrupted between a row and its mapping, the state is that of the row before: the last one is computed again.
    try {
      if (rows.size() < 2 || !rows[rows.size() - 2].has_mapping()) throw InputError("there is no mapping before it");
      restore_mapping_of(rows[rows.size() - 2]);
      --position_;
    } catch (const Error&) {
      warn("the mapping of frame " + rows.back()["frame"] +
           " is missing, the next one starts from the source: " + reason);
    }
  }

  void step() {
    const int frame = run_.frames[position_];
    try {
      end_step(compare_frame(frame));
    } catch (const Cancelled&) {
      throw Error(ErrorClass::kCancelled, "cancelled after " + std::to_string(file_.rows().size()) + " of " +
                                              std::to_string(run_.frames.size()) + " rows; " + switched_on("resume") +
                                              " goes on with " + file_.path());
    }
  }

  /// After a frame without numbers from the source, as a run does that is resumed there.
  StartFrom start_of_step() const {
    const bool follows_error = position_ > 0 && !file_.rows()[position_ - 1]["error"].empty();
    return follows_error ? StartFrom::kSource : run_.start;
  }

  SeriesRow compare_frame(int frame) {
    // The share is the whole run's; each stage of a frame begins at 0 again.
    const double n = static_cast<double>(run_.frames.size());
    const Progress inner([&](const std::string& stage, double fraction) {
      share_ = std::max(share_, (static_cast<double>(position_) + fraction) / n);
      outer_.report(std::to_string(frame) + ": " + stage, share_);
    });
    inner.report("read", 0.0);
    try {
      const FrameInput input = run_.frame(frame);
      const CompareResult result = series_.step({&input.molecule, input.map, input.make_map}, start_of_step(), inner);
      return {frame, run_.reference, *run_.source.molecule, input.molecule, result, run_.options};
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      if (!run_.skip_errors)
        throw Error(error.error_class(), "frame " + std::to_string(frame) + ": " + error.message());
      ++summary_.n_skipped;
      return {frame, run_.reference, error.what()};
    }
  }

  void end_step(const SeriesRow& row) {
    if (position_ < file_.rows().size()) return compare_again(row);
    file_.add(row);
    ++summary_.n_rows;
    if (!saves_mappings() || !row["error"].empty()) return;
    if (const auto state = series_.state()) write_series_state(state_path(), *state, state_fingerprint(row["frame"]));
  }

  /// A row that is computed again must come out as it stands, or the rows would not belong together.
  void compare_again(const SeriesRow& row) const {
    const SeriesRow& earlier = file_.rows()[position_];
    for (const char* column : {"rmsd_A", "mean_displacement_A", "mean_abs_difference"}) {
      if (same_cell(earlier[column], row[column])) continue;
      throw InputError("frame " + row["frame"] + " now has " + column + " '" + row[column] + "' instead of '" +
                       earlier[column] + "' in " + file_.path() + ": its input has changed; " +
                       switched_on("overwrite") + " begins anew");
    }
  }

  const Trajectory& run_;
  SeriesCsv& file_;
  const Progress& outer_;
  Series series_;
  TrajectorySummary summary_;
  std::size_t position_ = 0;
  double share_ = 0;
};

}  // namespace

TrajectorySummary compare_frames(Engine& engine, const Trajectory& run, SeriesCsv& file, const Progress& progress,
                                 const std::function<void(const std::string&)>& warn) {
  return Run(engine, run, file, progress).go(warn);
}

}  // namespace espdiff
