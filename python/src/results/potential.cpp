// potential.cpp: potential(): a map of one molecule's charges.
#include "potential.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "base/error.h"
#include "engine/engine.h"
#include "io/files/atomic_file.h"
#include "io/grids/write_grid.h"
#include "potential/potential_series.h"
#include "python/src/boundary/arrays.h"
#include "python/src/boundary/run.h"
#include "python/src/states/inputs.h"

namespace espdiff::python {
namespace {

struct PyMap {
  Grid grid;
};

std::shared_ptr<PyMap> make_py_map(const StatePtr& state, const Settings& settings, const nb::object& progress) {
  auto made = std::make_shared<PyMap>();
  const Computation computation(settings);
  run(progress, [&](const Progress& told) {
    const LoadedState loaded = loaded_alone(state, computation, told).loaded;
    const PotentialChoice choice = choose_potential(computation.potential.potential, "auto", {facts_of(loaded)});
    if (!choice.method) throw InputError(state->molecule.name + " has no charges, of which a potential could be made");
    const PotentialOptions options = make_potential_options(
        *choice.method, with_salt(choice, computation.potential.given), computation.options.temperature_K, true);
    const std::unique_ptr<Engine> engine = computation.make_engine();
    PotentialSeries series(*engine, options);
    const bool in_cell = *choice.method == PotentialMethod::kPme && choice.own_cell;
    const bool all = in_cell && loaded.everything.size() > 0;
    made->grid = series.step(all ? loaded.everything : loaded.molecule, in_cell ? loaded.cell : std::nullopt, told);
  });
  return made;
}

/// (nx, ny, nz), x fastest in memory: NumPy's Fortran order.
nb::object values(nb::handle self) {
  const Grid& grid = nb::cast<const PyMap&>(self).grid;
  const auto size = [&](std::size_t axis) { return static_cast<std::size_t>(grid.lattice.size[axis]); };
  const std::size_t shape[3] = {size(0), size(1), size(2)};
  const std::int64_t strides[3] = {1, grid.lattice.size[0],
                                   static_cast<std::int64_t>(grid.lattice.size[0]) * grid.lattice.size[1]};
  return nb::cast(nb::ndarray<nb::numpy, const float>(grid.values.data(), 3, shape, self, strides));
}

std::tuple<double, double, double> as_tuple(Vec3d v) { return {v.x, v.y, v.z}; }

}  // namespace

void add_potential(nb::module_& module) {
  nb::class_<PyMap>(module, "Map", "A potential on a lattice; its values are read-only and not copied.")
      .def_prop_ro("values", &values, "(nx, ny, nz) float32.")
      .def_prop_ro(
          "origin", [](const PyMap& m) { return as_tuple(m.grid.lattice.origin); }, "A.")
      .def_prop_ro(
          "steps",
          [](const PyMap& m) {
            const auto& s = m.grid.lattice.step;
            return std::make_tuple(as_tuple(s[0]), as_tuple(s[1]), as_tuple(s[2]));
          },
          "The three vectors from a point to the next, A.")
      .def_prop_ro("unit", [](const PyMap& m) { return to_string(m.grid.unit); })
      .def_prop_ro("periodic", [](const PyMap& m) { return m.grid.periodic; })
      .def(
          "save",
          [](const PyMap& m, const std::filesystem::path& path) {
            const nb::gil_scoped_release unlocked;
            AtomicFile file(path.string());
            write_map(file, m.grid);
            file.commit();
          },
          nb::arg("path"), "Writes DX or VTI, by the name's ending. Raises InputError for other endings, IoError.");
  module.def("potential", &make_py_map, nb::arg("state"), nb::arg("settings"), nb::arg("progress").none());
}

}  // namespace espdiff::python
