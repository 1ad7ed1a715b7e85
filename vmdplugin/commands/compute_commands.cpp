// compute_commands.cpp: compare and surface start jobs of the worker; status, wait, cancel and delete manage them.
#include "base/error.h"
#include "certificate/result.h"
#include "commands.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "io/molecules/select_atoms.h"
#include "io/molecules/write_pqr.h"
#include "io/structures/structure_file.h"
#include "mapping/build_surface.h"
#include "options/options.h"
#include "options/settings.h"
#include "prepare/input_files.h"
#include "prepare/load_state.h"
#include "prepare/surface_radii.h"
#include "system/this_process.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
Computation parse_computation(DictReader& reader, bool* regularize) {
  Computation computation;
  reader.take(computing_settings(), computation.computing);
  computation.command_line = reader.text("command_line");
  if (regularize != nullptr) *regularize = reader.boolean("regularize", false);
  computation.options = make_options(reader.rest());
  return computation;
}

std::unique_ptr<Engine> engine_for(const Computation& computation) { return select_engine(computation.computing); }

namespace {

Computation parse_computation(Tcl_Obj* options, bool* regularize) {
  DictReader reader(options, "options");
  return vmdplugin::parse_computation(reader, regularize);
}

/// Runs on the worker's thread.
void run_preparation(PreparationObject& p, const Progress& progress) {
  const InputOptions& options = p.computation.options.input;
  LoadedState& state = p.state;
  if (p.molecule.path.empty()) {
    refuse_options_of_files(options, StateRole::kOnly, "this is a molecule of VMD; choose its atoms by `sel`");
    state.molecule = without_repeated_atoms(p.molecule.molecule);
    state.n_left_out = p.molecule.molecule.size() - state.molecule.size();
    state.preparation = charge_molecule(state.molecule, options, {}, state.charge_files, progress);
  } else {
    state = load_state(StructureFile(p.molecule.path), {p.molecule.structure}, options, progress);
  }
  check_left_out(options, {&state});
  AtomicFile file(p.path);
  write_pqr(file.stream(), state.molecule);
  file.commit();
  progress.report("write", 1.0);
}

/// ENDPOINT OPTIONS FILE OVERWRITE: charges for a molecule, which is written as a PQR file.
Tcl_Obj* prepare_command(const Call& call) {
  auto object = std::make_shared<PreparationObject>();
  object->molecule = parse_endpoint(call.arguments[0], "molecule");
  object->computation = parse_computation(call.arguments[1], nullptr);
  object->path = call.text(2);
  std::vector<std::string> inputs = input_files(object->computation.options.input);
  inputs.push_back(object->molecule.path);
  check_outputs(inputs, {object->path}, to_bool(call.arguments[3], "overwrite"));
  AtomicFile probe(object->path);
  object->job = Worker::instance().submit([keep = std::weak_ptr<PreparationObject>(object)](const Progress& progress) {
    if (const auto alive = keep.lock()) run_preparation(*alive, progress);
  });
  return to_obj(call.handles.add(object));
}

/// The handle owns the object; the job keeps it alive while it runs.
Tcl_Obj* compare_command(const Call& call) {
  auto object = std::make_shared<ComparisonObject>();
  object->computation = parse_computation(call.arguments[2], nullptr);
  object->study = {shared_endpoint(call.arguments[0], "source"), shared_endpoint(call.arguments[1], "target"),
                   object->computation.options};
  object->study.each_by_itself = true;
  object->study.command_line = object->computation.command_line;
  // A weak pointer: the object owns its job, and would never be freed.
  object->job = Worker::instance().submit([keep = std::weak_ptr<ComparisonObject>(object)](const Progress& progress) {
    if (const auto alive = keep.lock())
      static_cast<PairAnswer&>(*alive) = run_pair(alive->study, *engine_for(alive->computation), progress);
  });
  return to_obj(call.handles.add(object));
}

Tcl_Obj* surface(const Call& call) {
  bool regularize = false;
  auto object = std::make_shared<SurfaceObject>();
  object->computation = parse_computation(call.arguments[1], &regularize);
  object->given = shared_endpoint(call.arguments[0], "molecule");
  object->job =
      Worker::instance().submit([keep = std::weak_ptr<SurfaceObject>(object), regularize](const Progress& progress) {
        const auto alive = keep.lock();
        if (alive == nullptr) return;
        progress.report("read", 0.0);
        const std::unique_ptr<Engine> engine = engine_for(alive->computation);
        const CompareOptions& options = alive->computation.options;
        StateReader reader({options, {}, true}, {alive->given}, progress);
        ComparedState state = reader.read(StateRole::kOnly);
        reader.add_maps({&state});
        set_surface_radii({&state.loaded.molecule}, options.input.radii);
        alive->result = make_surface(*engine, state.side(), options, regularize, progress);
        alive->molecule = std::move(state.loaded.molecule);
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
  return_free_memory();
  return nullptr;
}

Tcl_Obj* list_handles(const Call& call) { return to_list(call.handles.names()); }

}  // namespace

std::vector<Command> compute_commands() {
  return {{"compare", 3, 3, "source target options", compare_command},
          {"surface", 2, 2, "molecule options", surface},
          {"prepare", 4, 4, "molecule options file overwrite", prepare_command},
          {"status", 1, 1, "handle", status},
          {"wait", 2, 2, "handle milliseconds", wait},
          {"cancel", 1, 1, "handle", cancel},
          {"check", 1, 1, "handle", check},
          {"delete", 1, 1, "handle", remove},
          {"handles", 0, 0, "", list_handles}};
}

}  // namespace espdiff::vmdplugin
