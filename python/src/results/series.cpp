// series.cpp: many targets against one source, whose surface is made once.
#include "compare/series.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <mutex>

#include "base/error.h"
#include "comparison.h"
#include "engine/engine.h"
#include "python/src/boundary/run.h"
#include "report/state_report.h"
#include "series.h"
#include "study/series_source.h"
#include "trajectory/trajectory_settings.h"

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
  PySeries(StatePtr source, const Settings& settings, const std::string& potential, const std::string& pme_cell,
           const std::string& start, const std::string& device, int threads, std::string call)
      : source_(std::move(source)),
        computation_(settings, potential, pme_cell, device, threads),
        start_(parse_start(start, computation_.options)),
        call_(std::move(call)) {}

  std::shared_ptr<Comparison> step(const StatePtr& target, const nb::object& progress) {
    auto made = std::make_shared<Comparison>();
    made->source = source_;
    made->target = target;
    made->options = computation_.options;
    run(progress, [&](const Progress& told) {
      const std::lock_guard<std::mutex> lock(one_at_a_time_);
      begin(told);
      StateReader reader(computation_.states(), {target}, told);
      ComparedState state = reader.read_frame(loaded_.loaded());
      add_map(*target, plan_, computation_.options.temperature_K, state);
      const CompareInput side = loaded_.frame(state, computation_.options.input);
      made->provenance = provenance_of(*engine_, call_, loaded_.state(), state);
      made->result = series_->step(side, start_, told);
      note_states(made->result, loaded_.loaded(), state.loaded, {});
      if (!made->result.has_potential) made->result.shapes_because = plan_.because();
      made->source_molecule = loaded_.surface();
      made->target_molecule = std::move(state.loaded.molecule);
    });
    return made;
  }

 private:
  /// Loads the source, at the first step.
  void begin(const Progress& progress) {
    if (series_ != nullptr) return;
    StateReader reader(computation_.states(), {source_}, progress);
    ComparedState source = reader.read(StateRole::kSource);
    plan_ = reader.add_maps({&source});
    loaded_.take(std::move(source), computation_.options.input);
    side_ = loaded_.side();
    engine_ = computation_.make_engine();
    series_ = std::make_unique<Series>(*engine_, side_, computation_.options);
  }

  StatePtr source_;
  Computation computation_;
  StartFrom start_;
  std::string call_;
  std::mutex one_at_a_time_;
  std::unique_ptr<Engine> engine_;
  SeriesSource loaded_;
  PotentialPlan plan_;
  CompareInput side_;
  std::unique_ptr<Series> series_;  // destroyed before what it refers to
};

}  // namespace

void add_series(nb::module_& module) {
  nb::class_<PySeries>(module, "Series",
                       "Many targets, such as the frames of a trajectory, against one source, whose surface and "
                       "potential are made once.")
      .def(nb::init<StatePtr, const Settings&, const std::string&, const std::string&, const std::string&,
                    const std::string&, int, std::string>(),
           nb::arg("source"), nb::arg("settings"), nb::arg("potential"), nb::arg("pme_cell"), nb::arg("start"),
           nb::arg("device"), nb::arg("threads"), nb::arg("call"))
      .def("step", &PySeries::step, nb::arg("target"), nb::arg("progress").none(), "Compares the next target.");
}

}  // namespace espdiff::python
