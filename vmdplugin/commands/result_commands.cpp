// result_commands.cpp: result, residues, table, range, export, report: results as values and as files.
#include <nlohmann/json.hpp>
#include <sstream>

#include "align/paired_residues.h"
#include "certificate/result.h"
#include "commands.h"
#include "io/files/atomic_file.h"
#include "io/files/check_outputs.h"
#include "io/molecules/write_pqr.h"
#include "mapping/build_surface.h"
#include "matrix/matrix_table.h"
#include "matrix/write_matrix.h"
#include "page/result_page.h"
#include "plot/automatic_range.h"
#include "report/compare_json.h"
#include "report/compare_table.h"
#include "report/records/metrics.h"
#include "report/residue_values.h"
#include "report/sections/preparation_json.h"
#include "report/state_report.h"
#include "report/write_compare.h"
#include "report/write_surface.h"
#include "vmdplugin/objects/ensemble_views.h"
#include "vmdplugin/objects/vertex_quantity.h"
#include "vmdplugin/values/option_spelling.h"
#include "vmdplugin/values/tcl_values.h"

namespace espdiff::vmdplugin {
namespace {

nlohmann::ordered_json json_of(const ComparisonObject& comparison, const OptionSpelling& spelling = bare_name) {
  return compare_json(comparison.source_molecule, comparison.target_molecule, comparison.result, comparison.options,
                      comparison.provenance, spelling);
}

nlohmann::ordered_json surface_result(const SurfaceObject& surface) {
  const SurfaceResult& r = surface.result;
  auto times = nlohmann::ordered_json::object();
  for (const auto& [stage, ms] : r.time_ms) times[stage] = ms;
  return {{"n_vertices", r.summary.n_vertices},
          {"n_triangles", r.summary.n_triangles},
          {"n_components", r.summary.n_components},
          {"n_cavities_left_out", r.summary.n_cavities_left_out},
          {"area_A2", r.summary.area_A2},
          {"cavity_area_A2", r.summary.cavity_area_A2},
          {"time_ms", times}};
}

/// The content of OUT.json with the run's statistics; a shard has no matrix.
nlohmann::ordered_json matrix_result(const MatrixObject& object) {
  const MatrixReport& report = object.report;
  auto json = report.matrix ? matrix_json(*report.matrix, metric_to_cluster_by(object.study.run, *report.matrix))
                            : nlohmann::ordered_json::object();
  json["pairs"] = report.n_pairs;
  json["resumed"] = report.n_resumed;
  json["seconds"] = report.seconds;
  json["files"] = report.files;
  return json;
}

/// What was written, whether VMD can read it, and what PDB2PQR did; without `preparation` where the molecule had
/// charges.
nlohmann::ordered_json preparation_result(const PreparationObject& object) {
  nlohmann::ordered_json json{{"file", object.path},
                              {"n_atoms", object.state.molecule.size()},
                              {"fits_pdb_columns", fits_pdb_columns(object.state.molecule)}};
  json["preparation"] =
      object.state.preparation ? preparation_json(*object.state.preparation) : nlohmann::ordered_json(nullptr);
  return json;
}

nlohmann::ordered_json json_result(const Call& call) {
  const std::string handle = call.text(0);
  const auto object = call.handles.find(handle);
  if (const auto* matrix = dynamic_cast<const MatrixObject*>(object.get())) {
    require_done(handle, *matrix);
    return matrix_result(*matrix);
  }
  if (const auto* surface = dynamic_cast<const SurfaceObject*>(object.get())) {
    require_done(handle, *surface);
    return surface_result(*surface);
  }
  if (const auto* preparation = dynamic_cast<const PreparationObject*>(object.get())) {
    require_done(handle, *preparation);
    return preparation_result(*preparation);
  }
  if (const auto ensemble = ensemble_result(handle, *object)) return *ensemble;
  const auto comparison = call.handles.finished_comparison(handle);
  auto json = json_of(*comparison);
  auto& reasons = json["certificate"]["reasons"] = nlohmann::ordered_json::array();
  for (const Message& reason : comparison->result.certificate.reasons) reasons.push_back(spelled(call.interp, reason));
  for (std::size_t k = 0; k < comparison->result.inputs.warnings.size(); ++k)
    json["warnings"][k]["text"] = spelled(call.interp, comparison->result.inputs.warnings[k].text);
  return json;
}

Tcl_Obj* result(const Call& call) { return to_obj(json_result(call)); }

/// The result as a text that keeps the values' types, for other languages.
Tcl_Obj* result_json(const Call& call) {
  return to_obj(json_result(call).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string insertion_of(const Residue& residue) {
  return std::string(residue.insertion_code == ' ' ? 0 : 1, residue.insertion_code);
}

Tcl_Obj* residues(const Call& call) {
  const auto comparison = call.handles.finished_comparison(call.text(0));
  const Molecule &source = comparison->source_molecule, &target = comparison->target_molecule;
  const std::vector<std::int32_t> partner = paired_residues(source, target, comparison->result.alignment.pairing);
  std::vector<Tcl_Obj*> rows;
  for (const ResidueRow& row : comparison->result.residues) {
    const Residue& residue = source.residues.at(row.residue);
    const Residue* const other = partner[row.residue] < 0 ? nullptr : &target.residues.at(partner[row.residue]);
    Tcl_Obj* const dict = to_dict({{"index", to_obj(row.residue)},
                                   {"chain", to_obj(residue.chain)},
                                   {"number", to_obj(static_cast<int>(residue.number))},
                                   {"insertion", to_obj(insertion_of(residue))},
                                   {"name", to_obj(residue.name)},
                                   {"target_chain", to_obj(other ? other->chain : "")},
                                   {"target_number", other ? to_obj(static_cast<int>(other->number)) : to_obj("")},
                                   {"target_insertion", to_obj(other ? insertion_of(*other) : "")},
                                   {"target_name", to_obj(other ? other->name : "")}});
    for (const Metric& metric : metrics()) {
      if (metric.has_residues())
        Tcl_DictObjPut(nullptr, dict, to_obj(metric.name), to_obj(value_of(metric, comparison->result, row)));
    }
    rows.push_back(dict);
  }
  return to_list(rows);
}

Tcl_Obj* table(const Call& call) {
  const auto object = call.handles.find(call.text(0));
  if (const auto text = ensemble_table(call.text(0), *object)) return to_obj(*text);
  if (dynamic_cast<const MatrixObject*>(object.get()) != nullptr) {
    const auto matrix = call.handles.finished_matrix(call.text(0));
    if (!matrix->report.matrix)
      throw InputError(call.text(0) + " is a part of a matrix; `espdiff merge` puts the parts together");
    std::ostringstream text;
    print_matrix(text, *matrix->report.matrix, metric_to_cluster_by(matrix->study.run, *matrix->report.matrix));
    return to_obj(text.str());
  }
  const auto comparison = call.handles.finished_comparison(call.text(0));
  std::ostringstream out;
  print_table(out, json_of(*comparison, [&](const NamedOption& option) { return spelled(call.interp, option); }));
  return to_obj(out.str());
}

Tcl_Obj* range(const Call& call) {
  const VertexQuantity quantity = vertex_quantity(call.text(0), *call.handles.find(call.text(0)), call.text(1));
  const QuantityRange range = range_of(quantity.values);
  return to_dict({{"min", to_obj(range.min)},
                  {"max", to_obj(range.max)},
                  {"p02", to_obj(range.p02)},
                  {"p98", to_obj(range.p98)},
                  {"limit", to_obj(automatic_limit(quantity.values))},
                  {"unit", to_obj(quantity.unit)},
                  {"label", to_obj(quantity.label)},
                  {"signed", to_obj(quantity.is_signed ? 1 : 0)},
                  {"n", to_obj(range.n)},
                  {"n_nan", to_obj(range.n_nan)}});
}

/// Paths of a comparison's input files; empty for inputs from memory.
std::vector<std::string> input_paths(const ComparisonObject& comparison) {
  std::vector<std::string> paths;
  for (const InputFile& input : comparison.provenance.inputs) paths.push_back(input.path);
  return paths;
}

Tcl_Obj* export_files(const Call& call) {
  const std::string handle = call.text(0), prefix = call.text(1);
  const bool with_inputs = to_bool(call.arguments[2], "inputs"), overwrites = to_bool(call.arguments[3], "overwrite");
  const auto object = call.handles.find(handle);
  if (const auto* surface = dynamic_cast<const SurfaceObject*>(object.get())) {
    require_done(handle, *surface);
    check_outputs({surface->given->path, surface->given->map_path}, {prefix + ".vtp"}, overwrites);
    write_surface(prefix + ".vtp", surface->molecule, surface->result, surface->result.unit);
    return to_list({prefix + ".vtp"});
  }
  const auto comparison = call.handles.finished_comparison(handle);
  const KeptInputs maps{comparison->study.source->map.get(), comparison->study.target->map.get()};  // of memory
  std::vector<std::string> files = {prefix + ".json", prefix + ".vtp", prefix + ".residues.csv"};
  if (!with_inputs) {
    for (const KeptFile& kept : comparison->kept) files.push_back(prefix + kept.ending);
  } else {
    for (const std::string& ending : kept_input_endings(maps)) files.push_back(prefix + ending);
  }
  check_outputs(input_paths(*comparison), files, overwrites);
  if (!with_inputs) {
    write_compare(prefix, comparison->source_molecule, comparison->target_molecule, comparison->result,
                  comparison->options, comparison->provenance, comparison->kept);
    return to_list(files);
  }
  std::vector<Tcl_Obj*> written;
  for (const std::string& path :
       write_compare_with_inputs(prefix, comparison->source_molecule, comparison->target_molecule, comparison->result,
                                 comparison->options, comparison->provenance, maps))
    written.push_back(to_obj(path));
  return to_list(written);
}

/// PREFIX FILE TITLE SURFACES OVERWRITE: the page of a result's files, its scales as wide as those of other surfaces
/// (VTP files).
Tcl_Obj* report_page(const Call& call) {
  const std::string prefix = call.text(0), path = call.text(1);
  std::vector<std::string> surfaces;
  for (Tcl_Obj* const surface : to_vector(call.arguments[3], "surfaces")) surfaces.push_back(to_string(surface));
  check_outputs(page_inputs(prefix), {path}, to_bool(call.arguments[4], "overwrite"));
  AtomicFile file(path);
  file.stream() << result_page(prefix, call.text(2), surfaces);
  file.commit();
  return to_obj(path);
}

/// Names of metrics that Tcl offers.
Tcl_Obj* check_output_files(const Call& call) {
  std::vector<std::string> lists[2];
  for (std::size_t i = 0; i < 2; ++i) {
    for (Tcl_Obj* const path : to_vector(call.arguments[i], i == 0 ? "inputs" : "outputs"))
      lists[i].push_back(to_string(path));
  }
  check_outputs(lists[0], lists[1], to_bool(call.arguments[2], "overwrite"));
  return nullptr;
}

/// The values of a quantity by residue; in the order of residues().
Tcl_Obj* residue_quantity(const Call& call) {
  const auto comparison = call.handles.finished_comparison(call.text(0));
  std::vector<Tcl_Obj*> values;
  for (const double value : residue_values(comparison->result, call.text(1))) values.push_back(to_obj(value));
  return to_dict({{"unit", to_obj(residue_unit(comparison->result, call.text(1)))}, {"values", to_list(values)}});
}

Tcl_Obj* residue_pdb(const Call& call) {
  const auto comparison = call.handles.finished_comparison(call.text(0));
  check_outputs(input_paths(*comparison), {call.text(2)}, to_bool(call.arguments[3], "overwrite"));
  write_residue_pdb(call.text(2), comparison->source_molecule, comparison->result, call.text(1));
  return call.arguments[2];
}

}  // namespace

std::vector<Command> result_commands() {
  return {{"result", 1, 1, "handle", result},
          {"result_json", 1, 1, "handle", result_json},
          {"residues", 1, 1, "handle", residues},
          {"residue_quantity", 2, 2, "handle quantity", residue_quantity},
          {"residue_pdb", 4, 4, "handle quantity file overwrite", residue_pdb},
          {"table", 1, 1, "handle", table},
          {"range", 2, 2, "handle quantity", range},
          {"check_outputs", 3, 3, "inputs outputs overwrite", check_output_files},
          {"export", 4, 4, "handle prefix inputs overwrite", export_files},
          {"report", 5, 5, "prefix file title surfaces overwrite", report_page}};
}

}  // namespace espdiff::vmdplugin
