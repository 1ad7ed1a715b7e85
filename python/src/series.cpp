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
#include "prepare/region.h"
#include "prepare/surface_radii.h"
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
      begin(told);
      std::vector<InputFile> inputs = source_inputs_;
      LoadedState loaded = load_target(*target, computation_, loaded_, told);
      note_inputs(*target, loaded, "target", inputs);
      const CompareInput side = side_of(*target, loaded, plan_, "target", inputs);
      set_frame_radii(surface_, loaded.molecule, computation_.options.input.radii);
      made->provenance = provenance_of(*engine_, call_, std::move(inputs));
      note_preparation("source", loaded_, made->provenance);
      note_preparation("target", loaded, made->provenance);
      made->result = series_->step(side, start_, told);
      if (!made->result.has_potential) made->result.shapes_because = plan_.because();
      made->source_molecule = surface_;
      made->target_molecule = std::move(loaded.molecule);
    });
    return made;
  }

 private:
  /// Loads the source, at the first step.
  void begin(const Progress& progress) {
    if (series_ != nullptr) return;
    loaded_ = load(*source_, StateRole::kSource, computation_, nullptr, progress);
    plan_ = plan_potential(computation_, {source_.get()}, {&loaded_});
    source_inputs_.clear();
    note_inputs(*source_, loaded_, "source", source_inputs_);
    side_ = side_of(*source_, loaded_, plan_, "source", source_inputs_);
    surface_ = loaded_.molecule;
    set_surface_radii({&surface_}, computation_.options.input.radii);
    side_.molecule = &surface_;
    side_.parts =
        source_parts(loaded_.molecule, loaded_.whole, loaded_.molecule, loaded_.whole, computation_.options.input);
    engine_ = computation_.make_engine();
    series_ = std::make_unique<Series>(*engine_, side_, computation_.options);
  }

  StatePtr source_;
  Computation computation_;
  StartFrom start_;
  std::string call_;
  std::mutex one_at_a_time_;
  std::unique_ptr<Engine> engine_;
  LoadedState loaded_;  // the source
  Molecule surface_;    // the source with the radii of its surface
  PotentialPlan plan_;
  std::vector<InputFile> source_inputs_;
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
