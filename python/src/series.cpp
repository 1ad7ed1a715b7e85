// series.cpp: many targets against one source, whose surface is made once.
#include "compare/series.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <mutex>
#include <optional>

#include "base/error.h"
#include "comparison.h"
#include "engine/engine.h"
#include "run.h"
#include "series.h"
#include "trajectory/trajectory.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

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
      begin(*target);
      std::vector<InputFile> inputs = source_files_;
      const CompareInput side = plan_->input_of(*target, "target", inputs);
      made->provenance = provenance_of(*engine_, call_, std::move(inputs));
      made->result = series_->step(side, start_, told);
      if (!made->result.has_potential) made->result.shapes_because = plan_->because();
    });
    return made;
  }

 private:
  /// The first target decides with the source which potential there is.
  void begin(const State& target) {
    if (series_ != nullptr) return;
    engine_ = computation_.make_engine();
    plan_.emplace(computation_, std::vector<const State*>{source_.get(), &target});
    source_files_.clear();
    side_ = plan_->input_of(*source_, "source", source_files_);
    series_ = std::make_unique<Series>(*engine_, side_, computation_.options);
  }

  StatePtr source_;
  Computation computation_;
  StartFrom start_;
  std::string call_;
  std::mutex one_at_a_time_;
  std::unique_ptr<Engine> engine_;
  std::optional<MapPlan> plan_;
  std::vector<InputFile> source_files_;
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
