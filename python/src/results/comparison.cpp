// comparison.cpp: compare(), and its result as arrays, numbers and files.
#include "comparison.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "certificate/slip.h"
#include "engine/engine.h"
#include "io/files/check_outputs.h"
#include "python/src/boundary/arrays.h"
#include "python/src/boundary/run.h"
#include "report/compare_answer.h"
#include "report/compare_json.h"
#include "report/compare_table.h"
#include "report/records/metrics.h"
#include "report/sections/potential_json.h"
#include "report/write_compare.h"

namespace espdiff::python {
namespace {

std::shared_ptr<Comparison> compare_states(const StatePtr& source, const StatePtr& target, const Settings& settings,
                                           const std::string& call, const nb::object& progress) {
  auto made = std::make_shared<Comparison>();
  made->source = source;
  made->target = target;
  const Computation computation(settings);
  PairStudy study{source, target, computation.options, computation.potential, false, true, call};
  run(progress, [&](const Progress& told) {
    static_cast<PairAnswer&>(*made) = run_pair(study, *computation.make_engine(), told);
  });
  return made;
}

std::vector<float> difference(const MappedSurface& s) {
  std::vector<float> values(s.potential_source.size());
  for (std::size_t v = 0; v < values.size(); ++v) values[v] = s.potential_target[v] - s.potential_source[v];
  return values;
}

nb::dict residue_columns(const Comparison& c) {
  nb::dict columns;
  nb::list chains, numbers, insertions, names;
  for (const ResidueRow& row : c.result.residues) {
    const Residue& residue = c.source_molecule.residues.at(row.residue);
    chains.append(residue.chain);
    numbers.append(residue.number);
    insertions.append(residue.insertion_code == ' ' ? std::string() : std::string(1, residue.insertion_code));
    names.append(residue.name);
  }
  columns["chain"] = chains;
  columns["number"] = numbers;
  columns["insertion_code"] = insertions;
  columns["name"] = names;
  for (const Metric& metric : metrics()) {
    if (!metric.has_residues()) continue;
    std::vector<double> values;
    for (const ResidueRow& row : c.result.residues) values.push_back(value_of(metric, c.result, row));
    columns[metric.name] = array_from(std::move(values));
  }
  return columns;
}

nb::dict metric_values(const Comparison& c) {
  nb::dict values;
  for (const Metric& metric : metrics()) {
    if (!metric.has_result()) continue;
    const double value =
        is_unchecked(metric, c.result) ? std::numeric_limits<double>::quiet_NaN() : value_of(metric, c.result);
    values[metric.name] = value;
  }
  return values;
}

std::string json_text(const Comparison& c) {
  return compare_json(c.source_molecule, c.target_molecule, c.result, c.options, c.provenance)
      .dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string table(const Comparison& c) {
  std::ostringstream out;
  const auto spelled = [](const NamedOption& option) {
    std::string name = option.name;
    for (char& letter : name) letter = letter == '-' ? '_' : letter;
    return option.value.empty() ? name : name + "=" + option.value;
  };
  print_table(out, compare_json(c.source_molecule, c.target_molecule, c.result, c.options, c.provenance, spelled));
  return out.str();
}

std::vector<std::string> save(const Comparison& c, const std::string& prefix) {
  std::vector<std::string> files{prefix + ".json", prefix + ".vtp", prefix + ".residues.csv"};
  for (const KeptFile& file : c.kept) files.push_back(prefix + file.ending);
  for (const std::string& ending : further_endings(c.options)) files.push_back(prefix + ending);
  std::vector<std::string> inputs;
  for (const InputFile& input : c.provenance.inputs) inputs.push_back(input.path);
  check_outputs(inputs, files);
  const nb::gil_scoped_release unlocked;
  write_compare(prefix, c.source_molecule, c.target_molecule, c.result, c.options, c.provenance, c.kept);
  return files;
}

nb::object copy_of(const VtpArray& array) {
  const auto copied = [&](auto zero) {
    using T = decltype(zero);
    const auto* const first = static_cast<const T*>(array.values);
    auto* const values =
        new std::vector<T>(first, first + array.n_tuples * static_cast<std::size_t>(array.n_components));
    const nb::capsule owner(values, [](void* kept) noexcept { delete static_cast<std::vector<T>*>(kept); });
    const std::size_t shape[2] = {array.n_tuples, static_cast<std::size_t>(array.n_components)};
    return nb::cast(nb::ndarray<nb::numpy, T>(values->data(), array.n_components == 1 ? 1 : 2, shape, owner));
  };
  switch (array.type) {
    case VtpType::kFloat64: return copied(0.0);
    case VtpType::kInt32: return copied(std::int32_t{0});
    case VtpType::kUInt8: return copied(std::uint8_t{0});
    case VtpType::kFloat32: break;
  }
  return copied(0.0F);
}

/// What OUT.vtp holds, as copies.
nb::dict surface_arrays(nb::handle self) {
  const Comparison& c = nb::cast<const Comparison&>(self);
  const SurfaceArrays surface(c.source_molecule, c.result, c.provenance.version);
  nb::dict points, cells, texts, all;
  for (const VtpArray& array : surface.file.point_arrays) points[array.name.c_str()] = copy_of(array);
  for (const VtpArray& array : surface.file.cell_arrays) cells[array.name.c_str()] = copy_of(array);
  for (const auto& [name, text] : surface.file.texts) texts[name.c_str()] = text;
  all["positions"] = copy_of(surface.file.points);
  all["triangles"] = view_of(*surface.file.triangles, self);
  all["points"] = points;
  all["cells"] = cells;
  all["texts"] = texts;
  return all;
}

std::string verdict_line(const Comparison& c) {
  std::ostringstream out;
  print_verdict_line(out, c.result);
  std::string line = out.str();
  while (!line.empty() && line.back() == '\n') line.pop_back();
  return line;
}

/// A property that views an array of the mapped surface.
template <typename T>
auto array_of(std::vector<T> MappedSurface::*member) {
  return [member](nb::handle self) { return view_of(nb::cast<const Comparison&>(self).result.surface.*member, self); };
}

}  // namespace

void add_comparison(nb::module_& module) {
  using S = MappedSurface;
  nb::class_<Comparison>(module, "Comparison", "The result of compare(); arrays are read-only and not copied.")
      .def_prop_ro("source", [](const Comparison& c) { return c.source; })
      .def_prop_ro("target", [](const Comparison& c) { return c.target; })
      .def_prop_ro("has_potential", [](const Comparison& c) { return c.result.potential.compared; })
      .def_prop_ro(
          "unit", [](const Comparison& c) { return potential_unit_text(c.result); },
          "Of potentials; of those that see neither water nor a dielectric, kT/e in vacuum.")
      .def_prop_ro("trustworthy", [](const Comparison& c) { return c.result.certificate.trustworthy; })
      .def_prop_ro("positions", array_of(&S::positions),
                   "(vertices, 3) float64, A: the source's surface mapped onto the target, in the target's frame.")
      .def_prop_ro("source_positions", array_of(&S::source_positions),
                   "(vertices, 3) float64, A: where each vertex lies on the source, in the source's frame.")
      .def_prop_ro("normals", array_of(&S::normals), "(vertices, 3) float32: outward, of the target.")
      .def_prop_ro("source_normals", array_of(&S::source_normals), "(vertices, 3) float32: outward, of the source.")
      .def_prop_ro("triangles", array_of(&S::triangles), "(triangles, 3) uint32: vertices, counter-clockwise.")
      .def_prop_ro("source_potential", array_of(&S::potential_source), "(vertices) float32; empty for shapes alone.")
      .def_prop_ro("target_potential", array_of(&S::potential_target), "(vertices) float32; empty for shapes alone.")
      .def_prop_ro(
          "difference", [](const Comparison& c) { return array_from(difference(c.result.surface)); },
          "(vertices) float32: potential on the target minus that on the source.")
      .def_prop_ro("displacement", array_of(&S::displacement), "(vertices) float32, A; NaN where unmatched.")
      .def_prop_ro("slip", array_of(&S::slip),
                   "(vertices) float32, A; NaN where unmatched or without partner; empty if no atoms pair.")
      .def_prop_ro("path_length", array_of(&S::path_length), "(vertices) float32, A; NaN where unmatched.")
      .def_prop_ro("residue_index", array_of(&S::residue), "(vertices) int32: row of `residues`; -1 for none.")
      .def_prop_ro("corrupt", array_of(&S::corrupt), "(triangles) uint8: not 0 where it is off the target's surface.")
      .def_prop_ro(
          "why", array_of(&S::why),
          "(triangles) uint8: 0 where it is trusted; 1 unmatched, 2 corrupt, 3 unpaired, 4 slipped, 5 on another "
          "residue, 6 its residue disagrees, 7 without a potential, 8 turned.")
      .def_prop_ro("target_residue_index", array_of(&S::target_residue),
                   "(vertices) int32: the target's residue where a vertex is mapped to; -1 for none.")
      .def_prop_ro("unmatched", array_of(&S::unmatched),
                   "(triangles) uint8: not 0 where it is unmatched; empty where all are matched.")
      .def_prop_ro(
          "area",
          [](const Comparison& c) {
            return array_from(matched_areas(c.result.surface, surface_areas(c.result.surface)));
          },
          "(vertices) float64, A^2: a third of a vertex's triangles, without unmatched and corrupt ones.")
      .def_prop_ro("metrics", &metric_values, "Every number of the comparison by name; NaN where there is none.")
      .def("residue_columns", &residue_columns, "The residue table by columns.")
      .def("surface_arrays", &surface_arrays, "What OUT.vtp holds: positions, triangles, points, cells, texts.")
      .def_prop_ro("verdict", &verdict_line, "The verdict and the main number in one line.")
      .def("json", &json_text, "The content of OUT.json.")
      .def("table", &table, "The table that the command line prints.")
      .def("save", &save, nb::arg("prefix"),
           "Writes PREFIX.json, PREFIX.vtp, PREFIX.residues.csv, and the states that no file holds as "
           "PREFIX.source.pqr and PREFIX.target.pqr; all or none. Returns their names. Raises IoError.");
  module.def("compare", &compare_states, nb::arg("source"), nb::arg("target"), nb::arg("settings"), nb::arg("call"),
             nb::arg("progress").none());
}

}  // namespace espdiff::python
