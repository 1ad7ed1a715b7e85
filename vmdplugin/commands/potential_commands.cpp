// potential_commands.cpp: potential, potential_frame, potential_put, potential_write: potentials of frames,
// and their average.
#include <algorithm>

#include "align/pair_atoms.h"
#include "base/error.h"
#include "commands.h"
#include "engine/engine.h"
#include "engine/select_engine.h"
#include "io/grids/write_grid.h"
#include "potential/map_series_request.h"
#include "potential/potential_series.h"
#include "vmdplugin/bridge/volume_store.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

/// The engine of the last potential is kept: for a small map, its plans and buffers take as long to make as the
/// potential. Only on the CPU, since a GPU's engine must be destroyed before the driver, and only if its buffers are
/// small. Used by the worker's thread only.
struct KeptEngine {
  ComputingOptions of;
  std::shared_ptr<Engine> engine;
};
KeptEngine& kept_engine() {
  static KeptEngine kept;
  return kept;
}

std::shared_ptr<Engine> take_engine(const ComputingOptions& wanted) {
  KeptEngine& kept = kept_engine();
  if (kept.engine == nullptr || kept.of.device != wanted.device || kept.of.threads != wanted.threads)
    return select_engine(wanted);
  return kept.engine;
}

void keep_engine(const PotentialObject& used) {
  constexpr std::size_t kMostPoints = std::size_t{1} << 22;  // 50 MB of buffers
  const bool is_small = used.engine->back_end() == "cpu" && used.series->average().n_points() <= kMostPoints;
  kept_engine() = {used.computing, is_small ? used.engine : nullptr};
}

Tcl_Obj* potential(const Call& call) {
  auto object = std::make_shared<PotentialObject>();
  DictReader reader(call.arguments[0], "options");
  reader.take(computing_settings(), object->computing);
  MapSeriesRequest request;
  reader.take(map_series_settings(), request);
  object->potential = options_of(request, take_potential_settings(reader), PmeOptions().temperature_K);
  object->potential.around_aligned = reader.boolean("around", false);
  object->keeps_frames = request.each;
  reader.finish();
  return to_obj(call.handles.add(object));
}

/// The frame's atoms; with names and residues if the superposition needs them.
Molecule frame_of(DictReader& reader, bool named) {
  const std::string name = reader.text("name", "frame");
  Molecule molecule = charged_atoms(reader.require("charges"), reader.require("coordinates"), name);
  if (Tcl_Obj* const radii = reader.find("radii")) {
    for (Tcl_Obj* const radius : to_vector(radii, name + ", radii"))
      molecule.radii.push_back(static_cast<float>(to_double(radius, name + ", radius")));
  }
  if (!named) {
    reader.find("atoms");
    return molecule;
  }
  const std::vector<Tcl_Obj*> atoms = to_vector(reader.require("atoms"), name + ", atoms");
  const Molecule with_names = named_atoms(atoms, molecule.positions, name);
  molecule.atoms = with_names.atoms;
  molecule.residues = with_names.residues;
  return molecule;
}

Tcl_Obj* potential_frame(const Call& call) {
  const auto object = call.handles.find_potential(call.text(0));
  if (object->job != nullptr && !object->job->finished())
    throw InputError(call.text(0) + " is still computing its last frame; wait for it");
  DictReader reader(call.arguments[1], "frame");
  const auto molecule =
      std::make_shared<const Molecule>(frame_of(reader, object->potential.align != AlignAtoms::kNone));
  std::optional<UnitCell> cell;
  if (Tcl_Obj* const numbers = reader.find("cell")) cell = parse_unit_cell(numbers, "cell");
  reader.finish();
  object->job = Worker::instance().submit(
      [keep = std::weak_ptr<PotentialObject>(object), molecule, cell](const Progress& progress) {
        const auto alive = keep.lock();
        if (alive == nullptr) return;
        if (alive->series == nullptr) {
          alive->engine = take_engine(alive->computing);
          alive->series = std::make_unique<PotentialSeries>(*alive->engine, alive->potential);
        }
        if (alive->keeps_frames) {
          alive->frame = alive->series->step(*molecule, cell, progress);
        } else {
          alive->series->add(*molecule, cell, progress);
        }
        keep_engine(*alive);
      });
  return nullptr;
}

/// "mean", "variance" or "error" of the frames so far, or "frame", the last one's own.
Grid average(const Call& call) {
  const std::string handle = call.text(0), which = call.text(1);
  const auto object = call.handles.find_potential(handle);
  require_done(handle, *object);
  if (object->series == nullptr) throw InputError(handle + " has no frames yet");
  const RunningMap& frames = object->series->average();
  if (which == "frame") {
    if (!object->keeps_frames) throw InputError(handle + " keeps no frame's own map; `averaging each` keeps them");
    Grid map = object->frame;
    map.name = "espdiff potential (kT/e, T=300K), " + object->frame.name;
    return map;
  }
  Grid map = which == "mean" ? frames.mean() : which == "variance" ? frames.variance() : frames.standard_error();
  const std::string n = std::to_string(frames.n_frames()) + (frames.n_frames() == 1 ? " frame" : " frames");
  const std::string unit = which == "variance" ? "(kT/e)^2" : "kT/e";
  map.name = "espdiff " + std::string(which == "mean" ? "potential (" : which + " of the potential (") + unit +
             ", T=300K), " + n;
  return map;
}

void check_average(const std::string& which) {
  if (which != "mean" && which != "variance" && which != "error" && which != "frame")
    throw InputError("'" + which + "' is not mean, variance, error or frame");
}

Tcl_Obj* potential_put(const Call& call) {
  check_average(call.text(1));
  Grid map = average(call);
  const std::string dataname = map.name, name = "espdiff-" + call.text(0) + "-" + call.text(1);
  put_volume(name, std::move(map), dataname);
  return to_obj(name);
}

Tcl_Obj* potential_write(const Call& call) {
  check_average(call.text(1));
  const std::string path = call.text(2);
  write_dx(path, average(call));
  return to_obj(path);
}

}  // namespace

std::vector<Command> potential_commands() {
  return {{"potential", 1, 1, "options", potential},
          {"potential_frame", 2, 2, "handle frame", potential_frame},
          {"potential_put", 2, 2, "handle average", potential_put},
          {"potential_write", 3, 3, "handle average file", potential_write}};
}

}  // namespace espdiff::vmdplugin
