// compute_commands.cpp: compare, surface, series: hand work to the worker; status, wait, cancel, delete: watch and end
// it.
#include "base/error.h"
#include "commands.h"
#include "compare/options.h"
#include "compare/result.h"
#include "compare/settings.h"
#include "compare/surface.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "tcl_values.h"
#include "trajectory/series_file.h"

namespace espdiff::vmdplugin {
Computation parse_computation(DictReader& reader, bool* regularize) {
  Computation computation;
  computation.device = reader.text("device", "auto");
  parse_device(computation.device);  // a wrong one is told at once
  computation.threads = reader.integer("threads", 0);
  if (computation.threads < 0)
    throw InputError("threads: " + std::to_string(computation.threads) + " is negative; 0 uses all");
  computation.command_line = reader.text("command_line");
  if (regularize != nullptr) *regularize = reader.boolean("regularize", false);
  computation.options = make_options(reader.rest());
  return computation;
}

std::unique_ptr<Engine> engine_for(const Computation& computation) {
  return select_engine(parse_device(computation.device), computation.threads);
}

namespace {

Computation parse_computation(Tcl_Obj* options, bool* regularize) {
  DictReader reader(options, "options");
  return vmdplugin::parse_computation(reader, regularize);
}

std::shared_ptr<SeriesObject> make_series(Tcl_Obj* source, const Computation& computation, const std::string& role) {
  auto series = std::make_shared<SeriesObject>();
  series->computation = computation;
  series->source = parse_endpoint(source, role);
  return series;
}

/// Runs on the worker's thread, one step after the other.
void run_step(ComparisonObject& step, StartFrom start, const Progress& progress) {
  SeriesObject& series = *step.series;
  progress.report("read", 0.0);
  if (series.engine == nullptr) series.engine = engine_for(series.computation);
  const double temperature_K = series.computation.options.temperature_K;
  load(series.source, temperature_K);
  load(step.target, temperature_K);
  if (series.series == nullptr) {
    series.series = std::make_unique<Series>(*series.engine, input_of(series.source), series.computation.options);
    if (series.restored) series.series->restore(std::move(*series.restored));
    series.restored.reset();
  }
  step.provenance.device = series.engine->back_end();
  step.provenance.device_description = series.engine->description();
  step.provenance.threads = series.engine->n_threads();
  step.provenance.command_line = series.computation.command_line;
  step.provenance.inputs = series.source.inputs;
  step.provenance.inputs.insert(step.provenance.inputs.end(), step.target.inputs.begin(), step.target.inputs.end());
  step.result = series.series->step(input_of(step.target), start, progress);
}

/// Submits a step; whoever holds the handle holds the object, the job holds it while it runs.
Tcl_Obj* submit_step(const Call& call, const std::shared_ptr<SeriesObject>& series, Endpoint target, StartFrom start) {
  auto step = std::make_shared<ComparisonObject>();
  step->series = series;
  step->target = std::move(target);
  // Not owned by its own job, which would keep it alive for ever.
  step->job =
      Worker::instance().submit([keep = std::weak_ptr<ComparisonObject>(step), start](const Progress& progress) {
        if (const auto alive = keep.lock()) run_step(*alive, start, progress);
      });
  return to_obj(call.handles.add(step));
}

Tcl_Obj* compare(const Call& call) {
  const Computation computation = parse_computation(call.arguments[2], nullptr);
  const auto series = make_series(call.arguments[0], computation, "source");
  return submit_step(call, series, parse_endpoint(call.arguments[1], "target"), StartFrom::kSource);
}

Tcl_Obj* series(const Call& call) {
  return to_obj(
      call.handles.add(make_series(call.arguments[0], parse_computation(call.arguments[1], nullptr), "source")));
}

Tcl_Obj* series_step(const Call& call) {
  const std::string start = call.text(2);
  if (start != "source" && start != "previous") throw InputError("start: '" + start + "' is not source or previous");
  return submit_step(call, call.handles.find_series(call.text(0)), parse_endpoint(call.arguments[1], "target"),
                     start == "previous" ? StartFrom::kPrevious : StartFrom::kSource);
}

/// The series of a finished step's handle: its state lies still until the next step is submitted.
Tcl_Obj* series_save(const Call& call) {
  const auto series = call.handles.find_series(call.text(0));
  if (series->series == nullptr) throw InputError(call.text(0) + " has made no step yet; there is nothing to save");
  const auto state = series->series->state();
  if (state) write_series_state(call.text(1), *state, call.text(2));
  return to_obj(state.has_value());
}

Tcl_Obj* series_restore(const Call& call) {
  const auto series = call.handles.find_series(call.text(0));
  series->restored = read_series_state(call.text(1), call.text(2));
  return nullptr;
}

Tcl_Obj* surface(const Call& call) {
  bool regularize = false;
  auto object = std::make_shared<SurfaceObject>();
  object->computation = parse_computation(call.arguments[1], &regularize);
  object->molecule = parse_endpoint(call.arguments[0], "molecule");
  object->job =
      Worker::instance().submit([keep = std::weak_ptr<SurfaceObject>(object), regularize](const Progress& progress) {
        const auto alive = keep.lock();
        if (alive == nullptr) return;
        progress.report("read", 0.0);
        const std::unique_ptr<Engine> engine = engine_for(alive->computation);
        load(alive->molecule, alive->computation.options.temperature_K);
        alive->result =
            make_surface(*engine, input_of(alive->molecule), alive->computation.options, regularize, progress);
      });
  return to_obj(call.handles.add(object));
}

Tcl_Obj* status(const Call& call) {
  const auto object = call.handles.find(call.text(0));
  Job::Status now;
  if (object->job == nullptr) {
    now.state = Job::State::kDone;
  } else {
    now = object->job->status();
  }
  return to_dict({{"kind", to_obj(object->kind())},
                  {"state", to_obj(name_of(now.state))},
                  {"stage", to_obj(now.stage)},
                  {"fraction", to_obj(now.fraction)}});
}

Tcl_Obj* wait(const Call& call) {
  const auto object = call.handles.find(call.text(0));
  const int milliseconds = to_int(call.arguments[1], "milliseconds");
  return to_obj(object->job == nullptr || object->job->wait(milliseconds));
}

Tcl_Obj* cancel(const Call& call) {
  const auto object = call.handles.find(call.text(0));
  if (object->job != nullptr) object->job->cancel();
  return nullptr;
}

Tcl_Obj* check(const Call& call) {
  require_done(call.text(0), *call.handles.find(call.text(0)));
  return nullptr;
}

Tcl_Obj* remove(const Call& call) {
  call.handles.remove(call.text(0));
  return nullptr;
}

Tcl_Obj* list_handles(const Call& call) { return to_list(call.handles.names()); }

}  // namespace

std::vector<Command> compute_commands() {
  return {{"compare", 3, 3, "source target options", compare},
          {"surface", 2, 2, "molecule options", surface},
          {"series", 2, 2, "reference options", series},
          {"series_step", 3, 3, "series target start", series_step},
          {"series_save", 3, 3, "series file fingerprint", series_save},
          {"series_restore", 3, 3, "series file fingerprint", series_restore},
          {"status", 1, 1, "handle", status},
          {"wait", 2, 2, "handle milliseconds", wait},
          {"cancel", 1, 1, "handle", cancel},
          {"check", 1, 1, "handle", check},
          {"delete", 1, 1, "handle", remove},
          {"handles", 0, 0, "", list_handles}};
}

}  // namespace espdiff::vmdplugin
