// about_commands.cpp: version, build, back_ends, settings, abi, models, map_unit, volumes: what this module is and
// offers.
#include "base/version.h"
#include "commands.h"
#include "engine/select_engine.h"
#include "io/read_dx.h"
#include "io/read_structure.h"
#include "molfile_bridge.h"
#include "pipeline/settings.h"
#include "tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

Tcl_Obj* version(const Call&) { return to_obj(kVersion); }

Tcl_Obj* build(const Call&) {
  bool cuda = false, vtk = false, gemmi = false;
#if defined(ESPDIFF_HAVE_CUDA)
  cuda = true;
#endif
#if defined(ESPDIFF_HAVE_VTK)
  vtk = true;
#endif
#if defined(ESPDIFF_HAVE_GEMMI)
  gemmi = true;
#endif
  return to_dict({{"cuda", to_obj(cuda)},
                  {"vtk", to_obj(vtk)},
                  {"gemmi", to_obj(gemmi)},
                  {"compiler", to_obj("g++ " __VERSION__)},
                  {"tcl", to_obj(TCL_PATCH_LEVEL)}});
}

Tcl_Obj* back_ends(const Call&) {
  std::vector<Tcl_Obj*> all;
  for (const auto& [status, fourier] :
       {std::pair(cpu_status(), cpu_fourier_status()), std::pair(cuda_status(), cuda_fourier_status())}) {
    all.push_back(to_dict({{"name", to_obj(status.name)},
                           {"available", to_obj(status.available)},
                           {"description", to_obj(status.description)},
                           {"fourier", to_dict({{"available", to_obj(fourier.available)},
                                                {"description", to_obj(fourier.description)}})}}));
  }
  return to_list(all);
}

const char* name_of(SettingKind kind) {
  switch (kind) {
    case SettingKind::kNumber: return "number";
    case SettingKind::kInteger: return "integer";
    case SettingKind::kBoolean: return "boolean";
    case SettingKind::kChoice: break;
  }
  return "choice";
}

Tcl_Obj* list_settings(const Call&) {
  const CompareOptions defaults;
  std::vector<Tcl_Obj*> all;
  for (const Setting& setting : settings()) {
    all.push_back(to_dict({{"name", to_obj(setting.name)},
                           {"group", to_obj(setting.group)},
                           {"kind", to_obj(name_of(setting.kind))},
                           {"choices", to_list(setting.choices)},
                           {"default", to_obj(setting.get(defaults))},
                           {"help", to_obj(setting.help)},
                           {"surface", to_obj(setting.of_surface)}}));
  }
  return to_list(all);
}

Tcl_Obj* abi(const Call&) {
  const int accepted = accepted_abi();
  std::vector<Tcl_Obj*> offered;
  for (const int version : {18, 17, 16}) offered.push_back(to_obj(version));
  return to_dict({{"in_vmd", to_obj(accepted != 0)},
                  {"abi", accepted != 0 ? to_obj(accepted) : Tcl_NewObj()},
                  {"offered", to_list(offered)},
                  {"volume_writer", to_obj(kVolumeWriter)},
                  {"volume_reader", to_obj(kVolumeReader)},
                  {"vti", to_obj(has_vti_reader())}});
}

Tcl_Obj* models(const Call& call) { return to_obj(count_models(call.text(0))); }

Tcl_Obj* map_unit(const Call& call) { return to_obj(to_string(potential_unit_of_file(call.text(0)))); }

Tcl_Obj* volumes(const Call&) { return to_list(volume_names()); }

Tcl_Obj* describe(const Call& call) {
  const auto description = describe_volume(call.text(0));
  if (!description) throw InputError("no volume named '" + call.text(0) + "' is in memory");
  const Lattice& lattice = description->lattice;
  const auto vector = [](Vec3d v) { return to_list({to_obj(v.x), to_obj(v.y), to_obj(v.z)}); };
  std::vector<Tcl_Obj*> size, steps;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size.push_back(to_obj(lattice.size[axis]));
    steps.push_back(vector(lattice.step[axis]));
  }
  return to_dict({{"size", to_list(size)},
                  {"origin", vector(lattice.origin)},
                  {"step", to_list(steps)},
                  {"unit", to_obj(to_string(description->unit))},
                  {"dataname", to_obj(description->dataname)}});
}

Tcl_Obj* forget_volume(const Call& call) {
  take_volume(call.text(0));
  return nullptr;
}

}  // namespace

std::vector<Command> about_commands() {
  return {{"version", 0, 0, "", version},
          {"build", 0, 0, "", build},
          {"back_ends", 0, 0, "", back_ends},
          {"settings", 0, 0, "", list_settings},
          {"abi", 0, 0, "", abi},
          {"models", 1, 1, "file", models},
          {"map_unit", 1, 1, "file", map_unit},
          {"volumes", 0, 0, "", volumes},
          {"describe_volume", 1, 1, "name", describe},
          {"forget_volume", 1, 1, "name", forget_volume}};
}

}  // namespace espdiff::vmdplugin
