// ensemble_result.cpp: arrays and numbers of an ensemble.
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble_result.h"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_json.h"
#include "ensemble/result/ensemble_table.h"
#include "python/src/boundary/arrays.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

const EnsembleResult& result_of(const PyEnsemble& e) { return *e.answer.result; }

/// A property that views an array of the test at each vertex; empty for one group.
auto tested(std::vector<double> PlaceTests::*member) {
  return [member](nb::handle self) {
    return view_of(result_of(nb::cast<const PyEnsemble&>(self)).test.vertices.*member, self);
  };
}

auto of_surface(std::vector<double> SurfaceTest::*member) {
  return [member](nb::handle self) { return view_of(result_of(nb::cast<const PyEnsemble&>(self)).test.*member, self); };
}

/// {group: array}
auto of_groups(std::vector<double> GroupColumns::*member) {
  return [member](nb::handle self) {
    nb::dict all;
    for (const GroupColumns& group : result_of(nb::cast<const PyEnsemble&>(self)).groups)
      all[group.name.c_str()] = view_of(group.*member, self);
    return all;
  };
}

nb::object patch(const PyEnsemble& e) {
  std::vector<double> numbers(result_of(e).tested.size(), 0);
  for (std::size_t k = 0; k < result_of(e).patches.size(); ++k) {
    for (const std::uint32_t v : result_of(e).patches[k].patch.vertices) numbers[v] = static_cast<double>(k + 1);
  }
  return nb::object(array_from(std::move(numbers)).attr("astype")("int32"));
}

/// The table of OUT.residues.csv.
nb::dict ensemble_residue_columns(const PyEnsemble& e) {
  const EnsembleResult& r = result_of(e);
  nb::dict columns;
  std::vector<std::string> labels;
  std::vector<double> area, significant, adjusted;
  std::vector<std::vector<double>> means(r.groups.size());
  for (const EnsembleResidue& residue : r.residues) {
    labels.push_back(residue.label);
    area.push_back(residue.area_A2);
    significant.push_back(residue.significant_area_A2);
    adjusted.push_back(residue.adjusted_p);
    for (std::size_t g = 0; g < means.size(); ++g) means[g].push_back(residue.means[g]);
  }
  columns["residue"] = labels;
  columns["area_A2"] = array_from(std::move(area));
  for (std::size_t g = 0; g < means.size(); ++g)
    columns[("mean_" + r.groups[g].name).c_str()] = array_from(std::move(means[g]));
  if (!r.compares) return columns;
  const PlaceTests& t = r.residue_tests;
  for (const auto& [name, values] : {std::pair("difference", &t.difference),
                                     {"low", &t.low},
                                     {"high", &t.high},
                                     {"t", &t.t},
                                     {"p", &t.p},
                                     {"p_false_discovery", &adjusted},
                                     {"significant_area_A2", &significant}})
    columns[name] = array_from(std::vector<double>(*values));
  return columns;
}

nb::object potential_of_frame(const PyEnsemble& e, std::size_t frame) {
  if (frame >= e.answer.file->plan().n_frames())
    throw InputError("frame: there is no frame " + std::to_string(frame) + "; there are " +
                     std::to_string(e.answer.file->plan().n_frames()));
  std::vector<float> values(e.answer.file->n_vertices());
  e.answer.file->read_values(frame, 0, values.size(), values.data());
  return array_from(std::move(values));
}

/// What each frame is and how it was mapped, by columns.
nb::dict frame_columns(const PyEnsemble& e) {
  const EnsembleFile& file = *e.answer.file;
  nb::dict columns;
  nb::list groups, replicates, numbers, trustworthy, notes;
  std::vector<double> rmsd, mean;
  for (std::size_t f = 0; f < file.plan().n_frames(); ++f) {
    const auto [replicate, number] = file.plan().place_of(f);
    const EnsembleFrame values = file.numbers(f);
    groups.append(file.plan().replicates[replicate].group);
    replicates.append(file.plan().replicates[replicate].name);
    numbers.append(number);
    trustworthy.append(values.trustworthy);
    notes.append(values.note);
    rmsd.push_back(values.rmsd_A);
    mean.push_back(values.mean_potential);
  }
  columns["group"] = groups;
  columns["replicate"] = replicates;
  columns["frame"] = numbers;
  columns["rmsd_A"] = array_from(std::move(rmsd));
  columns["mean_potential"] = array_from(std::move(mean));
  columns["trustworthy"] = trustworthy;
  columns["note"] = notes;
  return columns;
}

std::string ensemble_table(const PyEnsemble& e) {
  std::ostringstream out;
  print_ensemble(out, *e.answer.file, result_of(e));
  return out.str();
}

/// A property that views an array of the template's surface.
template <typename T>
auto of_template(std::vector<T> TemplateSurface::*member) {
  return [member](nb::handle self) {
    return view_of(nb::cast<const PyEnsemble&>(self).answer.file->surface().*member, self);
  };
}

}  // namespace

void add_ensemble_result(nb::module_& module) {
  using T = PlaceTests;
  nb::class_<PyEnsemble>(module, "Ensemble",
                         "The result of ensemble(); arrays are read-only and not copied. Those of the test are empty "
                         "for one group, and NaN where a vertex was not tested.")
      .def_prop_ro("positions", of_template(&TemplateSurface::positions), "(vertices, 3) float64, A: the template.")
      .def_prop_ro("normals", of_template(&TemplateSurface::normals), "(vertices, 3) float32, outward.")
      .def_prop_ro("triangles", of_template(&TemplateSurface::triangles), "(triangles, 3) uint32.")
      .def_prop_ro("residue_index", of_template(&TemplateSurface::residue), "(vertices) int32; -1 for none.")
      .def_prop_ro(
          "tested",
          [](nb::handle self) {
            return view_of(
                reinterpret_cast<const std::uint8_t*>(result_of(nb::cast<const PyEnsemble&>(self)).tested.data()),
                {result_of(nb::cast<const PyEnsemble&>(self)).tested.size()}, self);
          },
          "(vertices) uint8: not 0 where values are compared.")
      .def_prop_ro("means", of_groups(&GroupColumns::mean), "{group: (vertices) float64}: of the replicates' means.")
      .def_prop_ro("deviations", of_groups(&GroupColumns::deviation),
                   "{group: (vertices) float64}: standard deviation of frames within replicates.")
      .def_prop_ro("effective_samples", of_groups(&GroupColumns::effective), "{group: (vertices) float64}")
      .def_prop_ro("difference", tested(&T::difference), "(vertices) float64: second minus first group.")
      .def_prop_ro("low", tested(&T::low), "(vertices) float64: lower end of the confidence interval.")
      .def_prop_ro("high", tested(&T::high), "(vertices) float64: upper end.")
      .def_prop_ro("standard_error", tested(&T::error), "(vertices) float64.")
      .def_prop_ro("t", tested(&T::t), "(vertices) float64.")
      .def_prop_ro("p", tested(&T::p), "(vertices) float64: of each vertex alone.")
      .def_prop_ro("p_max_t", of_surface(&SurfaceTest::p_max_t), "(vertices) float64: family-wise.")
      .def_prop_ro("p_tfce", of_surface(&SurfaceTest::p_tfce), "(vertices) float64: family-wise.")
      .def_prop_ro(
          "p_family_wise",
          [](nb::handle self) { return view_of(result_of(nb::cast<const PyEnsemble&>(self)).family_wise(), self); },
          "(vertices) float64: p_tfce or p_max_t, by `control`.")
      .def_prop_ro("patch", &patch, "(vertices) int32: number of the significant patch, from 1; 0: none.")
      .def_prop_ro("n_frames", [](const PyEnsemble& e) { return e.answer.file->plan().n_frames(); })
      .def_prop_ro(
          "written", [](const PyEnsemble& e) { return e.answer.written; }, "Names of the files.")
      .def_prop_ro(
          "fields",
          [](const PyEnsemble& e) {
            nb::dict fields;
            for (const auto& [name, field] : e.fields) fields[name.c_str()] = field;
            return fields;
          },
          "{name: Ensemble}: the fields besides the potential.")
      .def_prop_ro("design_warnings", [](const PyEnsemble& e) { return e.warnings; })
      .def("potential", &potential_of_frame, nb::arg("frame"),
           "(vertices) float32: of one frame of all, counted from 0; NaN where unmatched.")
      .def("frame_columns", &frame_columns, "What each frame is, by columns.")
      .def("residue_columns", &ensemble_residue_columns, "The table of OUT.residues.csv by columns.")
      .def(
          "json",
          [](const PyEnsemble& e) {
            return ensemble_json(*e.answer.file, result_of(e))
                .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
          },
          "The content of OUT.json.")
      .def("table", &ensemble_table, "The table that the command line prints.");
}

}  // namespace espdiff::python
#endif
