// module.cpp: the extension module espdiff._core; the package around it gives its functions their Python form.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "base/version.h"
#include "command_line.h"
#include "compare/options.h"
#include "compare/settings.h"
#include "comparison.h"
#include "engine/select_engine.h"
#include "ensemble.h"
#include "errors.h"
#include "frames.h"
#include "matrix.h"
#include "potential.h"
#include "potential/potential_settings.h"
#include "report/metrics.h"
#include "series.h"
#include "state.h"
#include "surface.h"

namespace nb = nanobind;

namespace {

/// Name, kind, choices, default and help of every option.
nb::list list_settings() {
  nb::list rows;
  const espdiff::CompareOptions defaults;
  const auto add = [&](const std::string& name, const std::string& group, const std::vector<std::string>& choices,
                       const std::string& value, const std::string& help) {
    nb::dict row;
    row["name"] = name;
    row["group"] = group;
    row["choices"] = choices;
    row["default"] = value;
    row["help"] = help;
    rows.append(row);
  };
  for (const espdiff::Setting& s : espdiff::settings()) add(s.name, s.group, s.choices, s.get(defaults), s.help);
  for (const espdiff::PotentialSetting& s : espdiff::potential_settings())
    add(s.option, "Potentials", s.choices, "", s.help);
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
    rows.append(row);
  }
  return rows;
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
  espdiff::python::add_matrix(module);
  espdiff::python::add_ensemble(module);
  espdiff::python::add_command_line(module);
  module.def("settings", &list_settings,
             "Every option of compare() and its like: name, group, choices, default, help.");
  module.def("metrics", &list_metrics, "Every number of a comparison: name, label, unit, help.");
  module.def("status", &status, "Which back ends there are.");
}
