// module.cpp: the extension module espdiff._core; the package around it gives its functions their Python form.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "base/version.h"
#include "command_line.h"
#include "engine/select_engine.h"
#include "io/files/atomic_file.h"
#include "io/vtk/read_vtp.h"
#include "options/options.h"
#include "options/settings.h"
#include "page/result_page.h"
#include "plot/automatic_range.h"
#include "plot/colour_map.h"
#include "potential/potential_plan.h"
#include "potential/potential_settings.h"
#include "python/src/boundary/arrays.h"
#include "python/src/boundary/errors.h"
#include "python/src/results/comparison.h"
#include "python/src/results/ensemble.h"
#include "python/src/results/matrix.h"
#include "python/src/results/potential.h"
#include "python/src/results/series.h"
#include "python/src/results/surface.h"
#include "python/src/states/frames.h"
#include "python/src/states/prepare.h"
#include "python/src/states/state.h"
#include "report/records/metrics.h"
#include "study/matrix_settings.h"
#include "study/trajectory_study.h"
#ifdef ESPDIFF_HAVE_HDF5
#include "ensemble/ensemble_study.h"
#endif

namespace nb = nanobind;

namespace {

template <typename Options>
nb::dict described(const espdiff::OptionRow<Options>& row, const Options& defaults) {
  nb::dict made;
  made["name"] = row.name;
  made["key"] = "";
  made["kind"] = to_string(row.kind);
  made["group"] = row.group;
  made["choices"] = row.choices;
  made["default"] = row.get(defaults);
  made["help"] = row.help;
  made["accepts"] = row.accepts;
  return made;
}

template <typename Options>
void add_rows(nb::list& all, const std::vector<espdiff::OptionRow<Options>>& rows) {
  for (const auto& row : rows) all.append(described(row, Options()));
}

/// Every option of what computes.
nb::list list_settings() {
  nb::list rows;
  for (const espdiff::Setting& s : espdiff::settings()) {
    nb::dict row = described<espdiff::CompareOptions>(s, {});
    if (s.is_named || s.is_list) row["kind"] = s.is_named ? "named" : "list";
    if (s.name != espdiff::kThesisSetting) row["key"] = s.key();
    rows.append(row);
  }
  add_rows(rows, espdiff::potential_request_settings());
  for (const espdiff::PotentialSetting& s : espdiff::potential_settings()) {
    nb::dict row = described<espdiff::PotentialOptions>(s, {});
    row["group"] = "Potentials";
    row["default"] = "";  // that of one potential is none of another
    rows.append(row);
  }
  add_rows(rows, espdiff::computing_settings());
  return rows;
}

/// Those of matrix(), a trajectory or ensemble() besides the comparison's; none of ensembles without HDF5.
nb::list list_study_settings(const std::string& study) {
  nb::list rows;
  if (study == "matrix") add_rows(rows, espdiff::matrix_settings());
  if (study == "trajectory") {
    add_rows(rows, espdiff::trajectory_settings());
    add_rows(rows, espdiff::trajectory_file_settings());
    add_rows(rows, espdiff::pair_map_settings());
  }
#ifdef ESPDIFF_HAVE_HDF5
  if (study == "ensemble") add_rows(rows, espdiff::ensemble_settings());
#endif
  return rows;
}

nb::list list_metrics() {
  nb::list rows;
  for (const espdiff::Metric& m : espdiff::metrics()) {
    nb::dict row;
    row["name"] = m.name;
    row["label"] = m.label;
    row["unit"] = espdiff::unit_of(m, "potential");
    row["help"] = m.help;
    row["kind"] = m.unit == espdiff::MetricUnit::kCount ? "count" : "number";
    row["json"] = m.json_pointer();
    row["has_result"] = m.has_result();
    const espdiff::ShownUnit shown = espdiff::shown_unit(m, "potential");
    row["shown_unit"] = shown.unit;
    row["shown_factor"] = shown.factor;
    rows.append(row);
  }
  return rows;
}

nb::list signed_colours(int n) {
  nb::list colours;
  for (int i = 0; i < n; ++i) {
    const espdiff::Rgb c = espdiff::diverging_colour((i + 0.5) / n, espdiff::kRedBlue);
    colours.append(nb::make_tuple(c.red, c.green, c.blue));
  }
  return colours;
}

nb::object numbers(const espdiff::VtpNumbers& array) {
  const nb::object flat = espdiff::python::array_from(std::vector<double>(array.values));
  return array.n_components == 1 ? flat : nb::object(flat.attr("reshape")(-1, array.n_components));
}

/// As Comparison.surface_arrays(), of a file; all numbers are float64.
nb::dict read_surface(const std::string& path) {
  const espdiff::VtpContent content = espdiff::read_vtp(path);
  nb::dict all, points, cells, texts;
  for (const espdiff::VtpNumbers& array : content.point_arrays) points[array.name.c_str()] = numbers(array);
  for (const espdiff::VtpNumbers& array : content.cell_arrays) cells[array.name.c_str()] = numbers(array);
  for (const auto& [name, text] : content.texts) texts[name.c_str()] = text;
  std::vector<double> positions, corners;
  for (const espdiff::Vec3d& p : content.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
  for (const espdiff::Triangle& t : content.triangles) {
    for (const auto corner : t) corners.push_back(static_cast<double>(corner));
  }
  all["positions"] = nb::object(espdiff::python::array_from(std::move(positions)).attr("reshape")(-1, 3));
  all["triangles"] = nb::object(espdiff::python::array_from(std::move(corners)).attr("reshape")(-1, 3));
  all["points"] = points;
  all["cells"] = cells;
  all["texts"] = texts;
  return all;
}

nb::dict status() {
  nb::dict all;
  for (const auto& [name, status] : {std::pair("cpu", espdiff::cpu_status()),
                                     {"cuda", espdiff::cuda_status()},
                                     {"fourier transforms", espdiff::cpu_fourier_status()}}) {
    nb::dict row;
    row["available"] = status.available;
    row["description"] = status.description.plain();
    all[name] = row;
  }
  return all;
}

}  // namespace

NB_MODULE(_core, module) {
  module.doc() = "The engine of espdiff; use the package espdiff.";
  module.attr("__version__") = espdiff::kVersion;
  espdiff::python::add_errors(module);
  espdiff::python::add_state(module);
  espdiff::python::add_frames(module);
  espdiff::python::add_comparison(module);
  espdiff::python::add_series(module);
  espdiff::python::add_surface(module);
  espdiff::python::add_potential(module);
  espdiff::python::add_prepare(module);
  espdiff::python::add_matrix(module);
  espdiff::python::add_ensemble(module);
  espdiff::python::add_command_line(module);
  module.def(
      "settings", &list_settings,
      "Every option of compare() and its like: name, kind, its key in OUT.json, group, choices, default, help, and "
      "what it accepts.");
  module.def("study_settings", &list_study_settings, nb::arg("study"),
             "The options of matrix or ensemble besides those of compare(), in the same form.");
  module.def("automatic_limit", &espdiff::automatic_limit, nb::arg("values"), nb::arg("percentile") = 90.0,
             "The end of a colour scale when none is given, as of all pictures.");
  module.def("signed_colours", &signed_colours, nb::arg("n"),
             "n colours (red, green, blue; 0 to 255) from the lowest value to the highest, as pictures have them.");
  module.def(
      "report_page",
      [](const std::string& prefix, const std::string& title, const std::vector<std::string>& range_of) {
        const nb::gil_scoped_release unlocked;
        return espdiff::result_page(prefix, title, range_of);
      },
      nb::arg("prefix"), nb::arg("title"), nb::arg("range_of") = std::vector<std::string>(),
      "The files of a result as one page for any browser.");
  module.def(
      "write_page",
      [](const std::string& path, const std::string& page) {
        espdiff::AtomicFile file(path);
        file.stream() << page;
        file.commit();
      },
      nb::arg("path"), nb::arg("page"), "Writes a page, whole or not at all. Raises IoError.");
  module.def("read_surface", &read_surface, nb::arg("path"),
             "What a VTP file holds: positions, triangles, points, cells, texts. Raises IoError, FormatError.");
  module.def("metrics", &list_metrics, "Every number of a comparison: name, label, unit, help.");
  module.def("status", &status, "Which back ends there are.");
}
