// series.cpp: many targets against one source, whose surface is made once; runs over frames in files.
#include "series.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <mutex>

#include "comparison.h"
#include "engine/engine.h"
#include "python/src/boundary/run.h"
#include "study/pair_series.h"
#include "study/trajectory_study.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

/// By the trajectory's option of this name.
StartFrom parse_start(const std::string& text, const CompareOptions& options) {
  TrajectoryRequest request;
  set_rows(trajectory_settings(), request, {{"start", text}});
  return request.start_of(options);
}

/// A series with all that it refers to.
class PySeries {
 public:
  PySeries(StatePtr source, const Settings& settings, const std::string& start, const std::string& call)
      : source_(std::move(source)),
        computation_(settings),
        series_({source_, nullptr, computation_.options, computation_.potential, false, true, call},
                parse_start(start, computation_.options)) {}

  std::shared_ptr<Comparison> step(const StatePtr& target, const nb::object& progress) {
    auto made = std::make_shared<Comparison>();
    made->source = source_;
    made->target = target;
    run(progress, [&](const Progress& told) {
      const std::lock_guard<std::mutex> lock(one_at_a_time_);
      if (engine_ == nullptr) engine_ = computation_.make_engine();
      static_cast<PairAnswer&>(*made) = series_.step(target, *engine_, told);
    });
    return made;
  }

 private:
  StatePtr source_;
  Computation computation_;
  std::mutex one_at_a_time_;
  std::unique_ptr<Engine> engine_;
  PairSeries series_;  // destroyed before the engine
};

/// @returns frames, rows, skipped, resumed, trusted, and the warning of a resumed run
nb::dict run_over_frames(const nb::dict& order, const nb::object& progress) {
  const auto text = [&](const char* name) { return nb::cast<std::string>(order[name]); };
  const auto texts = [&](const char* name) { return nb::cast<std::vector<std::string>>(order[name]); };
  const Computation computation(nb::cast<Settings>(order["settings"]));
  TrajectoryStudy study;
  study.source = text("source");
  study.frames = texts("frames");
  study.source_frames = texts("source_frames");
  study.options = computation.options;
  study.potential = computation.potential;
  study.request.csv = text("csv");
  for (const auto& [name, value] : nb::cast<Settings>(order["options"])) {
    set_row(trajectory_settings(), study.request, name, value);
    set_row(trajectory_file_settings(), study, name, value);
    set_row(pair_map_settings(), study.maps, name, value);
  }
  std::string warning;
  study.tell = [&](const std::string& told) { warning = told; };
  TrajectorySummary summary;
  run(progress, [&](const Progress& told) { summary = run_trajectory(study, *computation.make_engine(), told); });
  nb::dict numbers;
  numbers["frames"] = summary.n_frames;
  numbers["rows"] = summary.n_rows;
  numbers["skipped"] = summary.n_skipped;
  numbers["resumed"] = summary.n_resumed;
  numbers["trusted"] = summary.n_trusted;
  numbers["warning"] = warning;
  return numbers;
}

}  // namespace

void add_series(nb::module_& module) {
  nb::class_<PySeries>(module, "Series",
                       "Many targets, such as the frames of a trajectory, against one source, whose surface and "
                       "potential are made once.")
      .def(nb::init<StatePtr, const Settings&, const std::string&, const std::string&>(), nb::arg("source"),
           nb::arg("settings"), nb::arg("start"), nb::arg("call"))
      .def("step", &PySeries::step, nb::arg("target"), nb::arg("progress").none(), "Compares the next target.");
  module.def("trajectory", &run_over_frames, nb::arg("order"), nb::arg("progress").none());
}

}  // namespace espdiff::python
