// ensemble_commands.cpp: ensembles from Tcl, whose frames come from files or from molecules in VMD.
#include "commands.h"
#include "vmdplugin/values/tcl_values.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "engine/engine.h"
#include "ensemble/ensemble_study.h"
#include "io/files/sha256.h"
#include "matrix/matrix_run.h"
#include "vmdplugin/objects/ensemble_object.h"
#endif
#include "base/error.h"

namespace espdiff::vmdplugin {
#ifdef ESPDIFF_HAVE_HDF5
namespace {

std::vector<std::string> texts_of(Tcl_Obj* list, const std::string& what) {
  std::vector<std::string> texts;
  for (Tcl_Obj* const text : to_vector(list, what)) texts.push_back(to_string(text));
  return texts;
}

/// {group G name N file {PATH ...} ?topology PATH?} or {group G name N origin TEXT sha256 S n_frames N}, whose frames
/// Tcl gives when they are asked for.
ReplicateRequest parse_replicate(Tcl_Obj* description, std::size_t number, EnsembleObject& object) {
  DictReader reader(description, "replicate " + std::to_string(number + 1));
  ReplicateRequest replicate;
  replicate.group = to_string(reader.require("group"));
  replicate.name = to_string(reader.require("name"));
  if (Tcl_Obj* const files = reader.find("file")) {
    replicate.files = texts_of(files, "files");
    replicate.topology = reader.text("topology");
  } else {
    replicate.origin = to_string(reader.require("origin"));
    replicate.sha256 = to_string(reader.require("sha256"));
    replicate.n_frames = static_cast<std::size_t>(reader.integer("n_frames", 0));
    // The object outlives its job, whose progress it is: see start().
    replicate.read = [&object, number](std::size_t frame, bool everything) {
      return object.frames.ask({number, frame, everything}, *object.progress);
    };
  }
  reader.finish();
  return replicate;
}

void parse_study(DictReader& reader, EnsembleStudy& study) {
  EnsembleRequest& inputs = study.inputs;
  study.run.output = to_string(reader.require("output"));
  reader.take(ensemble_settings(), study);
  if (Tcl_Obj* const map = reader.find("map")) {
    DictReader request(map, "map");
    inputs.potential.potential = to_string(request.require("kind"));
    inputs.potential.given = take_potential_settings(request);
    request.finish();
  }
  inputs.structure.include_hetero = reader.boolean("hetero", true);
  inputs.structure.include_water = reader.boolean("water", false);
  if (Tcl_Obj* const charges = reader.find("charges")) {
    const std::vector<std::string> words = texts_of(charges, "charges");
    for (std::size_t i = 0; i + 1 < words.size(); i += 2) inputs.charges[words[i]] = words[i + 1];
  }
  if (Tcl_Obj* const maps = reader.find("maps")) {
    const std::vector<std::string> words = texts_of(maps, "maps");
    for (std::size_t i = 0; i + 1 < words.size(); i += 2) inputs.maps.of_group[words[i]] = words[i + 1];
  }
}

void start(const std::shared_ptr<EnsembleObject>& object) {
  object->job = Worker::instance().submit([keep = std::weak_ptr<EnsembleObject>(object)](const Progress& progress) {
    const auto alive = keep.lock();
    if (alive == nullptr) return;
    alive->progress = &progress;
    alive->answer = run_study(
        alive->study, [&] { return engine_for(alive->computation); }, progress,
        [&](const Message& text) { alive->warnings.push_back(text.plain()); });
  });
}

/// REPLICATES OPTIONS: starts the run.
Tcl_Obj* ensemble(const Call& call) {
  auto object = std::make_shared<EnsembleObject>();
  DictReader reader(call.arguments[1], "options");
  parse_study(reader, object->study);
  object->computation = parse_computation(reader, nullptr);
  object->study.options = ensemble_options(reader.rest());
  for (Tcl_Obj* const description : to_vector(call.arguments[0], "replicates")) {
    auto& replicates = object->study.inputs.replicates;
    replicates.push_back(parse_replicate(description, replicates.size(), *object));
  }
  start(object);
  return to_obj(call.handles.add(object));
}

std::shared_ptr<EnsembleObject> find_ensemble(const Handles& handles, const std::string& handle) {
  const auto object = handles.find(handle);
  auto found = std::dynamic_pointer_cast<EnsembleObject>(object);
  if (found == nullptr) throw InputError(handle + " is " + kind_in_words(*object) + "; this needs an ensemble");
  return found;
}

/// The frame that the run waits for, {replicate R frame F everything B}; empty for none.
Tcl_Obj* ensemble_wanted(const Call& call) {
  const auto wanted = find_ensemble(call.handles, call.text(0))->frames.wanted();
  if (!wanted) return Tcl_NewObj();
  return to_dict({{"replicate", to_obj(wanted->replicate)},
                  {"frame", to_obj(wanted->frame)},
                  {"everything", to_obj(wanted->with_everything)}});
}

/// HANDLE ENDPOINT ?EVERYTHING CELL?: gives it; EVERYTHING is an endpoint of all atoms.
Tcl_Obj* ensemble_frame(const Call& call) {
  const auto object = find_ensemble(call.handles, call.text(0));
  LoadedState state;
  state.molecule = parse_endpoint(call.arguments[1], "frame").molecule;
  if (call.arguments.size() > 2) {
    state.everything = parse_endpoint(call.arguments[2], "frame").molecule;
    state.cell = parse_unit_cell(call.arguments[3], "cell");
  }
  object->frames.give(std::move(state));
  return nullptr;
}

/// HANDLE MESSAGE CLASS: the frame cannot be given.
Tcl_Obj* ensemble_refuse(const Call& call) {
  find_ensemble(call.handles, call.text(0))->frames.refuse(error_of_class(call.text(2), call.text(1)));
  return nullptr;
}

/// What the design cannot show.
Tcl_Obj* ensemble_warnings(const Call& call) {
  const auto object = find_ensemble(call.handles, call.text(0));
  require_done(call.text(0), *object);
  return to_list(object->warnings);
}

/// SHA-256 of frames as they come: that of the earlier ones' and the next bytes.
Tcl_Obj* chain_sha256(const Call& call) {
  int n = 0;
  const unsigned char* const bytes = Tcl_GetByteArrayFromObj(call.arguments[1], &n);
  const std::string before = call.text(0);
  Sha256 sum;
  sum.update(before.data(), before.size());
  if (n > 0) sum.update(bytes, static_cast<std::size_t>(n));
  return to_obj(sum.finish());
}

}  // namespace

std::vector<Command> ensemble_commands() {
  return {{"ensemble", 2, 2, "replicates options", ensemble},
          {"ensemble_wanted", 1, 1, "handle", ensemble_wanted},
          {"ensemble_frame", 2, 4, "handle endpoint ?everything cell?", ensemble_frame},
          {"ensemble_refuse", 3, 3, "handle message class", ensemble_refuse},
          {"ensemble_warnings", 1, 1, "handle", ensemble_warnings},
          {"chain_sha256", 2, 2, "before bytes", chain_sha256}};
}

#else

std::vector<Command> ensemble_commands() {
  return {{"ensemble", 2, 2, "replicates options", [](const Call&) -> Tcl_Obj* {
             throw DeviceError(
                 "ensembles need HDF5, and this espdiff was built without it; build it again where the "
                 "library is");
           }}};
}

#endif
}  // namespace espdiff::vmdplugin
