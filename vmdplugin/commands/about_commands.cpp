// about_commands.cpp: version, build, allocated_bytes, back_ends, device, settings, renamed_settings, metrics, abi,
// models, map_unit, colours, volumes: version and contents of this module.
#include <sstream>

#include "base/error.h"
#include "base/formatted.h"
#include "base/version.h"
#include "commands.h"
#include "engine/potential_stage.h"
#include "engine/select_engine.h"
#include "field/field_kinds.h"
#include "io/grids/read_dx.h"
#include "io/structures/structure_file.h"
#include "mapping/map_recipe.h"
#include "options/options.h"
#include "options/settings.h"
#include "page/page_texts.h"
#include "plot/colour_map.h"
#include "potential/map_series_request.h"
#include "potential/potential_plan.h"
#include "potential/potential_settings.h"
#include "prepare/load_state.h"
#include "scene/scene.h"
#include "study/matrix_settings.h"
#include "trajectory/trajectory_settings.h"
#include "vmdplugin/bridge/molfile_bridge.h"
#include "vmdplugin/values/option_spelling.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble/ensemble_study.h"
#endif
#include "options/input_settings.h"
#include "prepare/charges/open_babel.h"
#include "prepare/charges/pdb2pqr.h"
#include "report/records/metrics.h"
#include "system/this_process.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

Tcl_Obj* version(const Call&) { return to_obj(kVersion); }

Tcl_Obj* build(const Call&) {
  bool cuda = false, vtk = false, gemmi = false, hdf5 = false;
#if defined(ESPDIFF_HAVE_CUDA)
  cuda = true;
#endif
#if defined(ESPDIFF_HAVE_VTK)
  vtk = true;
#endif
#if defined(ESPDIFF_HAVE_GEMMI)
  gemmi = true;
#endif
#if defined(ESPDIFF_HAVE_HDF5)
  hdf5 = true;
#endif
  const LigandSupport ligands = ligand_support();
  return to_dict(
      {{"cuda", to_obj(cuda)},
       {"vtk", to_obj(vtk)},
       {"gemmi", to_obj(gemmi)},
       {"hdf5", to_obj(hdf5)},
       {"pages", to_obj(page_texts().count("three.min.js") > 0)},
       {"pdb2pqr", to_obj(find_pdb2pqr())},
       {"pdb2pqr_remedy", to_obj(kPdb2pqrRemedy)},
       {"ligands", to_dict({{"available", to_obj(ligands.is_there)}, {"description", to_obj(ligands.text)}})},
       {"compiler", to_obj("g++ " __VERSION__)},
       {"tcl", to_obj(TCL_PATCH_LEVEL)}});
}

Tcl_Obj* allocated(const Call&) { return to_obj(static_cast<std::size_t>(allocated_bytes())); }

/// The devices that a name given as -device means.
Tcl_Obj* device(const Call& call) {
  const BackEndStatus status = device_status(parse_device(call.text(0)));
  return to_dict({{"name", to_obj(status.name)}, {"description", to_obj(spelled(call.interp, status.description))}});
}

Tcl_Obj* back_ends(const Call& call) {
  std::vector<Tcl_Obj*> gpus;
  for (const BackEndStatus& gpu : cuda_devices())
    gpus.push_back(to_dict({{"name", to_obj(gpu.name)},
                            {"available", to_obj(gpu.available)},
                            {"description", to_obj(spelled(call.interp, gpu.description))}}));
  std::vector<Tcl_Obj*> all;
  for (const auto& [status, fourier] :
       {std::pair(cpu_status(), cpu_fourier_status()), std::pair(cuda_status(), cuda_fourier_status())}) {
    all.push_back(
        to_dict({{"name", to_obj(status.name)},
                 {"available", to_obj(status.available)},
                 {"description", to_obj(spelled(call.interp, status.description))},
                 {"devices", status.name == "cuda" ? to_list(gpus) : Tcl_NewObj()},
                 {"fourier", to_dict({{"available", to_obj(fourier.available)},
                                      {"description", to_obj(spelled(call.interp, fourier.description))}})}}));
  }
  return to_list(all);
}

Tcl_Obj* list_settings(const Call&) {
  const CompareOptions defaults;
  std::vector<Tcl_Obj*> all;
  for (const Setting& setting : settings()) {
    all.push_back(to_dict({{"name", to_obj(setting.name)},
                           {"group", to_obj(setting.group)},
                           {"kind", to_obj(setting.is_named ? "named" : to_string(setting.kind))},
                           {"choices", to_list(setting.choices)},
                           {"default", to_obj(setting.get(defaults))},
                           {"help", to_obj(setting.help)},
                           {"accepts", to_obj(setting.accepts)},
                           {"surface", to_obj(setting.of_surface)},
                           {"preparation", to_obj(is_of_preparation(setting))},
                           {"list", to_obj(setting.is_list)},
                           {"file", to_obj(setting.is_file)}}));
  }
  return to_list(all);
}

template <typename Study>
Tcl_Obj* list_rows(const std::vector<OptionRow<Study>>& rows) {
  const Study defaults;
  std::vector<Tcl_Obj*> all;
  for (const OptionRow<Study>& row : rows) {
    all.push_back(to_dict({{"name", to_obj(row.name)},
                           {"group", to_obj(row.group)},
                           {"kind", to_obj(row.is_file ? "file" : to_string(row.kind))},
                           {"choices", to_list(row.choices)},
                           {"default", to_obj(row.get(defaults))},
                           {"help", to_obj(row.help)},
                           {"accepts", to_obj(row.accepts)}}));
  }
  return to_list(all);
}

/// STUDY: the options of `matrix`, `trajectory`, `ensemble` or `potential` besides those of a comparison; those of all
/// that compute (`computing`), or of pictures (`scene`).
Tcl_Obj* list_study_settings(const Call& call) {
  const std::string study = call.text(0);
  if (study == "computing") return list_rows(computing_settings());
  if (study == "scene") return list_rows(scene_options());
  if (study == "matrix") return list_rows(matrix_settings());
  if (study == "merge") return list_rows(merge_settings());
  if (study == "potential") return list_rows(map_series_settings());
  if (study == "trajectory") return list_rows(trajectory_settings());
#ifdef ESPDIFF_HAVE_HDF5
  if (study == "ensemble") return list_rows(ensemble_settings());
#endif
  return Tcl_NewListObj(0, nullptr);
}

/// The options of computed potentials, as list_settings().
Tcl_Obj* list_potential_settings(const Call&) {
  const double temperature_K = PmeOptions().temperature_K;
  const PotentialOptions defaults = make_potential_options(PotentialMethod::kPme, {}, temperature_K),
                         map_defaults = make_potential_options(PotentialMethod::kPme, {}, temperature_K, true);
  std::vector<Tcl_Obj*> all;
  for (const PotentialSetting& setting : potential_settings()) {
    std::vector<std::string> of;
    for (const PotentialMethod method : setting.of) of.push_back(to_string(method));
    all.push_back(to_dict({{"name", to_obj(setting.key)},
                           {"of", to_list(of)},
                           {"kind", to_obj(to_string(setting.kind))},
                           {"choices", to_list(setting.choices)},
                           {"default", to_obj(setting.get(defaults))},
                           {"map_option", to_obj(setting.map_option())},
                           {"map_default", to_obj(setting.get(map_defaults))},
                           {"help", to_obj(setting.help)},
                           {"accepts", to_obj(setting.accepts)}}));
  }
  return to_list(all);
}

/// Earlier names with the present ones.
Tcl_Obj* list_renamed(const Call&) {
  Tcl_Obj* const dict = Tcl_NewDictObj();
  for (const RenamedSetting& renamed : renamed_settings())
    Tcl_DictObjPut(nullptr, dict, to_obj(renamed.old_name), to_obj(renamed.name));
  return dict;
}

const char* name_of(MetricUnit unit) {
  switch (unit) {
    case MetricUnit::kPotential: return "potential";
    case MetricUnit::kAngstrom: return "length";
    case MetricUnit::kSquareAngstrom: return "area";
    case MetricUnit::kFraction: return "fraction";
    case MetricUnit::kIndex: return "index";
    case MetricUnit::kCount: break;
  }
  return "count";
}

const char* name_of(MetricSection section) {
  switch (section) {
    case MetricSection::kSuperposition: return "superposition";
    case MetricSection::kPotential: return "potential";
    case MetricSection::kShape: return "shape";
    case MetricSection::kSurface: return "surface";
    case MetricSection::kCertificate: return "certificate";
    case MetricSection::kMapping: break;
  }
  return "mapping";
}

/// The keys of a metric in `espdiff result`; empty if only residues have it.
std::vector<std::string> result_keys(const Metric& metric) {
  std::vector<std::string> keys;
  std::istringstream parts(metric.has_result() ? metric.json_pointer() : "");
  for (std::string key; std::getline(parts, key, '/');) {
    if (!key.empty()) keys.push_back(key);
  }
  return keys;
}

/// The table of metrics. `unit` is `potential` if the unit is that of the potentials. Values times `factor` are in
/// that unit.
Tcl_Obj* list_metrics(const Call&) {
  std::vector<Tcl_Obj*> all;
  for (const Metric& metric : metrics()) {
    const ShownUnit shown = shown_unit(metric, "potential");
    all.push_back(to_dict({{"name", to_obj(metric.name)},
                           {"title", to_obj(metric.label)},
                           {"section", to_obj(name_of(metric.section))},
                           {"kind", to_obj(name_of(metric.unit))},
                           {"unit", to_obj(shown.unit)},
                           {"factor", to_obj(shown.factor)},
                           {"help", to_obj(metric.help)},
                           {"keys", to_list(result_keys(metric))},
                           {"residues", to_obj(metric.has_residues())},
                           {"series", to_obj((metric.flags & kInSeries) != 0)},
                           {"matrix", to_obj((metric.flags & kInMatrix) != 0)}}));
  }
  return to_list(all);
}

/// Whether a file has charges and explicit solvent: {charges B solvent B}.
Tcl_Obj* facts_of_file(const Call& call) {
  const int model = to_int(call.arguments[1], "model");
  const StructureFile file(call.text(0));
  const Molecule everything = read_as_it_is(file, {model, true, true, {}});
  const PotentialFacts facts = potential_facts(everything, file.unit_cell(model));
  // Structures without charges get some.
  const bool charges = facts.has_charges || !find_pdb2pqr().empty();
  return to_dict({{"charges", to_obj(charges)},
                  {"solvent", to_obj(facts.has_solvent)},
                  {"waters", to_obj(static_cast<int>(facts.n_waters))},
                  {"ions", to_obj(static_cast<int>(facts.n_ions))},
                  {"ion_squares", to_obj(facts.ion_squares)}});
}

/// The rule for molecules whose user named no potential: a list of {name B charges B solvent} each; returns
/// {kind because}; the kind is none if only shapes are compared.
Tcl_Obj* usual_potential(const Call& call) {
  std::vector<PotentialFacts> molecules;
  for (Tcl_Obj* const molecule : to_vector(call.arguments[0], "molecules")) {
    DictReader reader(molecule, "molecule");
    PotentialFacts facts{reader.text("name"), reader.boolean("charges", false), reader.boolean("solvent", false)};
    facts.n_waters = static_cast<std::size_t>(reader.integer("waters", 0));
    facts.n_ions = static_cast<std::size_t>(reader.integer("ions", 0));
    facts.ion_squares = reader.number("ion_squares", 0);
    molecules.push_back(facts);
  }
  const PotentialChoice choice = choose_potential("auto", "auto", molecules);
  std::string kind = choice.method ? to_string(*choice.method) : std::string("none");
  for (const auto& [key, value] : with_salt(choice, {})) kind += " " + key + " " + value;
  return to_list({kind, reason_in_full(choice)});
}

Tcl_Obj* abi(const Call&) {
  const int accepted = accepted_abi();
  std::vector<Tcl_Obj*> offered;
  for (const int version : {18, 17, 16}) offered.push_back(to_obj(version));
  return to_dict({{"in_vmd", to_obj(accepted != 0)},
                  {"abi", accepted != 0 ? to_obj(accepted) : Tcl_NewObj()},
                  {"offered", to_list(offered)},
                  {"volume_writer", to_obj(kVolumeWriter)},
                  {"volume_reader", to_obj(kVolumeReader)}});
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

/// Colours from the lowest value to the highest, by Tk's names. The kind is sequential, or the name of a diverging map.
Tcl_Obj* colours(const Call& call) {
  const std::string kind = call.text(0);
  const int n = to_int(call.arguments[1], "number");
  if (n < 2 || n > 1000) throw InputError("a scale of " + std::to_string(n) + " colours; use 2 to 1000");
  const DivergingMap* const map = kind == "sequential" ? nullptr : &diverging_map(kind);
  std::vector<std::string> all;
  for (int i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / (n - 1);
    const Rgb c = map != nullptr ? diverging_colour(t, *map) : sequential_colour(t);
    all.push_back(formatted("#%02x%02x%02x", c.red, c.green, c.blue));
  }
  return to_list(all);
}

}  // namespace

Tcl_Obj* list_field_kinds(const Call&) {
  std::vector<std::string> names;
  for (const FieldKind& kind : field_kinds()) names.push_back(kind.quantity.name);
  return to_list(names);
}

std::vector<Command> about_commands() {
  return {{"version", 0, 0, "", version},
          {"build", 0, 0, "", build},
          {"allocated_bytes", 0, 0, "", allocated},
          {"back_ends", 0, 0, "", back_ends},
          {"device", 1, 1, "name", device},
          {"settings", 0, 0, "", list_settings},
          {"study_settings", 1, 1, "study", list_study_settings},
          {"potential_settings", 0, 0, "", list_potential_settings},
          {"potential_facts", 2, 2, "file model", facts_of_file},
          {"usual_potential", 1, 1, "molecules", usual_potential},
          {"renamed_settings", 0, 0, "", list_renamed},
          {"metrics", 0, 0, "", list_metrics},
          {"field_kinds", 0, 0, "", list_field_kinds},
          {"abi", 0, 0, "", abi},
          {"models", 1, 1, "file", models},
          {"map_unit", 1, 1, "file", map_unit},
          {"colours", 2, 2, "kind number", colours},
          {"volumes", 0, 0, "", volumes},
          {"describe_volume", 1, 1, "name", describe},
          {"forget_volume", 1, 1, "name", forget_volume}};
}

}  // namespace espdiff::vmdplugin
