// prepare.cpp: prepare(): a state with charges, as comparisons give them.
#include "prepare.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <nlohmann/json.hpp>

#include "inputs.h"
#include "python/src/boundary/run.h"
#include "report/sections/preparation_json.h"

namespace espdiff::python {
namespace {

namespace nb = nanobind;

StatePtr prepare(const StatePtr& state, const Settings& settings, const nb::object& progress) {
  auto made = std::make_shared<State>();
  Computation computation(settings);
  computation.potential.potential = "pb";  // any computed potential needs charges
  run(progress, [&](const Progress& told) {
    LoadedState loaded = loaded_alone(state, computation, told).loaded;
    check_left_out(computation.options.input, {&loaded});
    made->molecule = std::move(loaded.molecule);
    made->cell = loaded.cell;
    if (loaded.preparation)
      made->preparation =
          preparation_json(*loaded.preparation).dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
    note_input(*made);
  });
  return made;
}

}  // namespace

void add_prepare(nb::module_& module) {
  module.def("prepare", &prepare, nb::arg("state"), nb::arg("settings"), nb::arg("progress").none());
}

}  // namespace espdiff::python
