// result_commands.cpp: result, residues, table, range, export: what came out, as values and as files.
#include <nlohmann/json.hpp>
#include <sstream>

#include "commands.h"
#include "pipeline/write_surface.h"
#include "tcl_values.h"
#include "vertex_quantity.h"

namespace espdiff::vmdplugin {
namespace {

std::string json_of(const ComparisonObject& comparison) {
  const SeriesObject& series = *comparison.series;
  return compare_json(*series.source.molecule, *comparison.target.molecule, comparison.result,
                      series.computation.options, comparison.provenance);
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

Tcl_Obj* result(const Call& call) {
  const std::string handle = call.text(0);
  const auto object = call.handles.find(handle);
  if (const auto* surface = dynamic_cast<const SurfaceObject*>(object.get())) {
    require_done(handle, *surface);
    return surface_result(*surface);
  }
  auto json = nlohmann::ordered_json::parse(json_of(*call.handles.finished_comparison(handle)));
  for (auto& reason : json["certificate"]["reasons"]) reason = in_tcl_words(reason.get<std::string>());
  return to_obj(json);
}

Tcl_Obj* residues(const Call& call) {
  const auto comparison = call.handles.finished_comparison(call.text(0));
  const Molecule& source = *comparison->series->source.molecule;
  std::vector<Tcl_Obj*> rows;
  for (const ResidueRow& row : comparison->result.residues) {
    const Residue& residue = source.residues.at(row.residue);
    const std::string insertion(residue.insertion_code == ' ' ? 0 : 1, residue.insertion_code);
    rows.push_back(to_dict({{"index", to_obj(row.residue)},
                            {"chain", to_obj(residue.chain)},
                            {"number", to_obj(static_cast<int>(residue.number))},
                            {"insertion", to_obj(insertion)},
                            {"name", to_obj(residue.name)},
                            {"area_A2", to_obj(row.area_A2)},
                            {"mean_abs_difference", to_obj(row.mean_abs_difference)},
                            {"mean_signed_difference", to_obj(row.mean_signed_difference)},
                            {"mean_source", to_obj(row.mean_source)},
                            {"mean_target", to_obj(row.mean_target)},
                            {"sign_change_area_fraction", to_obj(row.sign_change_area_fraction)},
                            {"mean_displacement_A", to_obj(row.mean_displacement_A)},
                            {"mean_path_length_A", to_obj(row.mean_path_length_A)}}));
  }
  return to_list(rows);
}

Tcl_Obj* table(const Call& call) {
  const auto comparison = call.handles.finished_comparison(call.text(0));
  std::ostringstream out;
  print_table(out, *comparison->series->source.molecule, *comparison->target.molecule, comparison->result);
  return to_obj(in_tcl_words(out.str()));
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

Tcl_Obj* export_files(const Call& call) {
  const std::string handle = call.text(0), prefix = call.text(1);
  const auto object = call.handles.find(handle);
  if (const auto* surface = dynamic_cast<const SurfaceObject*>(object.get())) {
    require_done(handle, *surface);
    const PotentialUnit unit = surface->molecule.map ? surface->molecule.map->unit : PotentialUnit::kUnknown;
    write_surface(prefix + ".vtp", *surface->molecule.molecule, surface->result, unit);
    return to_list({prefix + ".vtp"});
  }
  const auto comparison = call.handles.finished_comparison(handle);
  const SeriesObject& series = *comparison->series;
  write_compare(prefix, *series.source.molecule, *comparison->target.molecule, comparison->result,
                series.computation.options, comparison->provenance);
  return to_list({prefix + ".json", prefix + ".vtp", prefix + ".residues.csv"});
}

}  // namespace

std::vector<Command> result_commands() {
  return {{"result", 1, 1, "handle", result},
          {"residues", 1, 1, "handle", residues},
          {"table", 1, 1, "handle", table},
          {"range", 2, 2, "handle quantity", range},
          {"export", 2, 2, "handle prefix", export_files}};
}

}  // namespace espdiff::vmdplugin
