// compute_commands.cpp: compare and surface start jobs of the worker; status, wait, cancel and delete manage them.
#include "base/error.h"
#include "commands.h"
#include "compare/compare.h"
#include "compare/options.h"
#include "compare/result.h"
#include "compare/settings.h"
#include "compare/surface.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/atomic_file.h"
#include "io/check_outputs.h"
#include "prepare/input_files.h"
#include "io/read_structure.h"
#include "io/select_atoms.h"
#include "io/structure_file.h"
#include "io/write_pqr.h"
#include "prepare/load_state.h"
#include "prepare/region.h"
#include "prepare/surface_radii.h"
#include "report/state_report.h"
#include "system/this_process.h"
#include "tcl_values.h"

namespace espdiff::vmdplugin {
Computation parse_computation(DictReader& reader, bool* regularize) {
  Computation computation;
  computation.device = reader.text("device", "auto");
  parse_device(computation.device);  // reports a wrong one at once
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

/// Runs on the worker's thread.
void run_comparison(ComparisonObject& c, const Progress& progress) {
  progress.report("read", 0.0);
  const std::unique_ptr<Engine> engine = engine_for(c.computation);
  const CompareOptions& options = c.computation.options;
  load(c.source, options, nullptr, progress);
  load(c.target, options, &c.source, progress);
  if (!c.source.structure_path.empty() && !c.target.structure_path.empty())
    check_left_out(options.input, {&c.source.state, &c.target.state});
  for (Endpoint* side : {&c.source, &c.target}) {
    for (KeptFile& kept : kept_structure(side->role, side->state)) c.kept.push_back(std::move(kept));
    if (side->state.preparation)
      c.provenance.preparations.emplace_back(side->role, std::make_shared<Preparation>(*side->state.preparation));
  }
  const auto whole = [](const Endpoint& side) -> const Molecule& {
    return side.state.whole.size() > 0 ? side.state.whole : *side.molecule;
  };
  add_parts(c.source,
            source_parts(*c.source.molecule, whole(c.source), *c.target.molecule, whole(c.target), options.input));
  const std::string radii_note = set_surface_radii({&*c.source.molecule, &*c.target.molecule}, options.input.radii);
  c.provenance.device = engine->back_end();
  c.provenance.device_description = engine->description();
  c.provenance.threads = engine->n_threads();
  c.provenance.command_line = c.computation.command_line;
  c.provenance.inputs = c.source.inputs;
  c.provenance.inputs.insert(c.provenance.inputs.end(), c.target.inputs.begin(), c.target.inputs.end());
  c.result = compare(*engine, input_of(c.source), input_of(c.target), options, progress);
  note_states(c.result, c.source.state, c.target.state, radii_note);
}

/// Runs on the worker's thread.
void run_preparation(PreparationObject& p, const Progress& progress) {
  const InputOptions& options = p.computation.options.input;
  LoadedState& state = p.molecule.state;
  if (p.molecule.molecule) {
    state.molecule = without_repeated_atoms(*p.molecule.molecule);
    state.n_left_out = p.molecule.molecule->size() - state.molecule.size();
    state.preparation = charge_molecule(state.molecule, options, {}, state.charge_files, progress);
  } else {
    state = load_state(StructureFile(p.molecule.structure_path), {p.molecule.structure}, options, progress);
    check_left_out(options, {&state});
  }
  AtomicFile file(p.path);
  write_pqr(file.stream(), state.molecule);
  file.commit();
  progress.report("write", 1.0);
}

/// ENDPOINT OPTIONS FILE: charges for a molecule, which is written as a PQR file.
Tcl_Obj* prepare_command(const Call& call) {
  auto object = std::make_shared<PreparationObject>();
  object->molecule = parse_endpoint(call.arguments[0], "molecule");
  object->computation = parse_computation(call.arguments[1], nullptr);
  object->path = call.text(2);
  std::vector<std::string> inputs = input_files(object->computation.options.input);
  inputs.push_back(object->molecule.structure_path);
  check_outputs(inputs, {object->path});
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
  object->source = parse_endpoint(call.arguments[0], "source");
  object->target = parse_endpoint(call.arguments[1], "target");
  // A weak pointer: the object owns its job, and would never be freed.
  object->job = Worker::instance().submit([keep = std::weak_ptr<ComparisonObject>(object)](const Progress& progress) {
    if (const auto alive = keep.lock()) run_comparison(*alive, progress);
  });
  return to_obj(call.handles.add(object));
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
        load(alive->molecule, alive->computation.options, nullptr, progress);
        set_surface_radii({&*alive->molecule.molecule}, alive->computation.options.input.radii);
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
  return_free_memory();
  return nullptr;
}

Tcl_Obj* list_handles(const Call& call) { return to_list(call.handles.names()); }

}  // namespace

std::vector<Command> compute_commands() {
  return {{"compare", 3, 3, "source target options", compare_command},
          {"surface", 2, 2, "molecule options", surface},
          {"prepare", 3, 3, "molecule options file", prepare_command},
          {"status", 1, 1, "handle", status},
          {"wait", 2, 2, "handle milliseconds", wait},
          {"cancel", 1, 1, "handle", cancel},
          {"check", 1, 1, "handle", check},
          {"delete", 1, 1, "handle", remove},
          {"handles", 0, 0, "", list_handles}};
}

}  // namespace espdiff::vmdplugin
