// result_commands.cpp: result, residues, table, range, export: results as values and as files.
#include <nlohmann/json.hpp>
#include <sstream>

#include "commands.h"
#include "compare/paired_residues.h"
#include "compare/result.h"
#include "compare/surface.h"
#include "ensemble_views.h"
#include "io/check_outputs.h"
#include "matrix/write_matrix.h"
#include "option_spelling.h"
#include "report/metrics.h"
#include "report/preparation_json.h"
#include "report/residue_values.h"
#include "report/state_report.h"
#include "report/write_compare.h"
#include "report/write_surface.h"
#include "tcl_values.h"
#include "vertex_quantity.h"

namespace espdiff::vmdplugin {
namespace {

nlohmann::ordered_json json_of(const ComparisonObject& comparison) {
  return compare_json(*comparison.source.molecule, *comparison.target.molecule, comparison.result,
                      comparison.computation.options, comparison.provenance);
}

Tcl_Obj* surface_result(const SurfaceObject& surface) {
  const SurfaceResult& r = surface.result;
  Tcl_Obj* const times = Tcl_NewDictObj();
  for (const auto& [stage, ms] : r.time_ms) Tcl_DictObjPut(nullptr, times, to_obj(stage), to_obj(ms));
  return to_dict({{"n_vertices", to_obj(r.summary.n_vertices)},
                  {"n_triangles", to_obj(r.summary.n_triangles)},
                  {"n_components", to_obj(r.summary.n_components)},
                  {"n_cavities_left_out", to_obj(r.summary.n_cavities_left_out)},
                  {"area_A2", to_obj(r.summary.area_A2)},
                  {"cavity_area_A2", to_obj(r.summary.cavity_area_A2)},
                  {"time_ms", times}});
}

/// The result as JSON with the run's statistics; a shard has no matrix.
Tcl_Obj* matrix_result(const MatrixObject& object) {
  const MatrixReport& report = object.report;
  Tcl_Obj* const dict = report.matrix
                            ? to_obj(matrix_json(*report.matrix, metric_to_cluster_by(object.run, *report.matrix)))
                            : Tcl_NewDictObj();
  const std::pair<const char*, Tcl_Obj*> about[] = {{"pairs", to_obj(report.n_pairs)},
                                                    {"resumed", to_obj(report.n_resumed)},
                                                    {"seconds", to_obj(report.seconds)},
                                                    {"files", to_list(report.files)}};
  for (const auto& [key, value] : about) Tcl_DictObjPut(nullptr, dict, to_obj(key), value);
  return dict;
}

/// What was written, and what PDB2PQR did; without `preparation` where the molecule had charges.
Tcl_Obj* preparation_result(const PreparationObject& object) {
  nlohmann::ordered_json json{{"file", object.path}, {"n_atoms", object.molecule.state.molecule.size()}};
  json["preparation"] = object.molecule.state.preparation ? preparation_json(*object.molecule.state.preparation)
                                                          : nlohmann::ordered_json(nullptr);
  return to_obj(json);
}

Tcl_Obj* result(const Call& call) {
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
  if (const auto ensemble = ensemble_result(handle, *object)) return to_obj(*ensemble);
  const auto comparison = call.handles.finished_comparison(handle);
  auto json = json_of(*comparison);
  auto& reasons = json["certificate"]["reasons"] = nlohmann::ordered_json::array();
  for (const Message& reason : comparison->result.certificate.reasons) reasons.push_back(spelled(call.interp, reason));
  for (std::size_t k = 0; k < comparison->result.warnings.size(); ++k)
    json["warnings"][k]["text"] = spelled(call.interp, comparison->result.warnings[k].text);
  return to_obj(json);
}

std::string name_of_partner(const Molecule& target, std::int32_t residue) {
  return residue < 0 ? "" : target.residues[static_cast<std::size_t>(residue)].name;
}

Tcl_Obj* residues(const Call& call) {
  const auto comparison = call.handles.finished_comparison(call.text(0));
  const Molecule &source = *comparison->source.molecule, &target = *comparison->target.molecule;
  const std::vector<std::int32_t> partner = paired_residues(source, target, comparison->result.pairing);
  std::vector<Tcl_Obj*> rows;
  for (const ResidueRow& row : comparison->result.residues) {
    const Residue& residue = source.residues.at(row.residue);
    const std::string insertion(residue.insertion_code == ' ' ? 0 : 1, residue.insertion_code);
    Tcl_Obj* const dict = to_dict({{"index", to_obj(row.residue)},
                                   {"chain", to_obj(residue.chain)},
                                   {"number", to_obj(static_cast<int>(residue.number))},
                                   {"insertion", to_obj(insertion)},
                                   {"name", to_obj(residue.name)},
                                   {"target_name", to_obj(name_of_partner(target, partner[row.residue]))}});
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
    print_matrix(text, *matrix->report.matrix, metric_to_cluster_by(matrix->run, *matrix->report.matrix));
    return to_obj(text.str());
  }
  const auto comparison = call.handles.finished_comparison(call.text(0));
  std::ostringstream out;
  print_table(out, *comparison->source.molecule, *comparison->target.molecule, comparison->result,
              [&](const NamedOption& option) { return spelled(call.interp, option); });
  return to_obj(out.str());
}

Tcl_Obj* range(const Call& call) {
  const VertexQuantity quantity = vertex_quantity(call.text(0), *call.handles.find(call.text(0)), call.text(1));
  const QuantityRange range = range_of(quantity.values);
  return to_dict({{"min", to_obj(range.min)},
                  {"max", to_obj(range.max)},
                  {"p02", to_obj(range.p02)},
                  {"p98", to_obj(range.p98)},
                  {"unit", to_obj(quantity.unit)},
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
  const auto object = call.handles.find(handle);
  if (const auto* surface = dynamic_cast<const SurfaceObject*>(object.get())) {
    require_done(handle, *surface);
    check_outputs({surface->molecule.structure_path, surface->molecule.map_path}, {prefix + ".vtp"});
    write_surface(prefix + ".vtp", *surface->molecule.molecule, surface->result, surface->result.unit);
    return to_list({prefix + ".vtp"});
  }
  const auto comparison = call.handles.finished_comparison(handle);
  const Endpoint &source = comparison->source, &target = comparison->target;
  check_outputs(input_paths(*comparison), {prefix + ".json", prefix + ".vtp", prefix + ".residues.csv"});
  if (!to_bool(call.arguments[2], "inputs")) {
    write_compare(prefix, *source.molecule, *target.molecule, comparison->result, comparison->computation.options,
                  comparison->provenance, comparison->kept);
    std::vector<std::string> written{prefix + ".json", prefix + ".vtp", prefix + ".residues.csv"};
    for (const KeptFile& kept : comparison->kept) written.push_back(prefix + kept.ending);
    return to_list(written);
  }
  const auto from_memory = [](const Endpoint& endpoint) {
    return endpoint.map && endpoint.map_path.empty() ? &*endpoint.map : nullptr;
  };
  std::vector<Tcl_Obj*> written;
  for (const std::string& path : write_compare_with_inputs(
           prefix, *source.molecule, *target.molecule, comparison->result, comparison->computation.options,
           comparison->provenance, {from_memory(source), from_memory(target)}))
    written.push_back(to_obj(path));
  return to_list(written);
}

/// Names of metrics that Tcl offers.
Tcl_Obj* check_output_files(const Call& call) {
  std::vector<std::string> lists[2];
  for (std::size_t i = 0; i < 2; ++i) {
    for (Tcl_Obj* const path : to_vector(call.arguments[i], i == 0 ? "inputs" : "outputs"))
      lists[i].push_back(to_string(path));
  }
  check_outputs(lists[0], lists[1]);
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
  check_outputs(input_paths(*comparison), {call.text(2)});
  write_residue_pdb(call.text(2), *comparison->source.molecule, comparison->result, call.text(1));
  return call.arguments[2];
}

}  // namespace

std::vector<Command> result_commands() {
  return {{"result", 1, 1, "handle", result},
          {"residues", 1, 1, "handle", residues},
          {"residue_quantity", 2, 2, "handle quantity", residue_quantity},
          {"residue_pdb", 3, 3, "handle quantity file", residue_pdb},
          {"table", 1, 1, "handle", table},
          {"range", 2, 2, "handle quantity", range},
          {"check_outputs", 2, 2, "inputs outputs", check_output_files},
          {"export", 3, 3, "handle prefix inputs", export_files}};
}

}  // namespace espdiff::vmdplugin
