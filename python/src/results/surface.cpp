// surface.cpp: surface(): one molecule's surface, with its potential.
#include "mapping/build_surface.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "engine/engine.h"
#include "prepare/surface_radii.h"
#include "python/src/boundary/arrays.h"
#include "python/src/boundary/run.h"
#include "python/src/states/inputs.h"
#include "report/write_surface.h"
#include "surface.h"

namespace espdiff::python {
namespace {

struct PySurface {
  Molecule molecule;  ///< as its surface was made
  SurfaceResult result;
};

std::shared_ptr<PySurface> make_py_surface(const StatePtr& state, const Settings& settings, bool regularize,
                                           const nb::object& progress) {
  auto made = std::make_shared<PySurface>();
  const Computation computation(settings);
  run(progress, [&](const Progress& told) {
    StateReader reader(computation.states(), {state}, told);
    ComparedState only = reader.read(StateRole::kOnly);
    reader.add_maps({&only});
    set_surface_radii({&only.loaded.molecule}, computation.options.input.radii);
    const std::unique_ptr<Engine> engine = computation.make_engine();
    made->result = make_surface(*engine, only.side(), computation.options, regularize, told);
    made->molecule = std::move(only.loaded.molecule);
  });
  return made;
}

}  // namespace

void add_surface(nb::module_& module) {
  nb::class_<PySurface>(module, "Surface", "The result of surface(); arrays are read-only and not copied.")
      .def_prop_ro(
          "positions", [](nb::handle self) { return view_of(nb::cast<const PySurface&>(self).result.positions, self); },
          "(vertices, 3) float64, A.")
      .def_prop_ro(
          "normals",
          [](nb::handle self) { return view_of(nb::cast<const PySurface&>(self).result.mesh.normals, self); },
          "(vertices, 3) float32, outward.")
      .def_prop_ro(
          "triangles",
          [](nb::handle self) { return view_of(nb::cast<const PySurface&>(self).result.mesh.triangles, self); },
          "(triangles, 3) uint32, counter-clockwise.")
      .def_prop_ro(
          "residue_index",
          [](nb::handle self) { return view_of(nb::cast<const PySurface&>(self).result.residue, self); },
          "(vertices) int32: residue of the molecule; -1 for none.")
      .def_prop_ro(
          "potential", [](nb::handle self) { return view_of(nb::cast<const PySurface&>(self).result.potential, self); },
          "(vertices) float32; empty without charges or map.")
      .def_prop_ro("unit", [](const PySurface& s) { return to_string(s.result.unit); })
      .def_prop_ro(
          "area", [](const PySurface& s) { return s.result.summary.area_A2; }, "A^2.")
      .def(
          "save",
          [](const PySurface& s, const std::filesystem::path& path) {
            const nb::gil_scoped_release unlocked;
            write_surface(path.string(), s.molecule, s.result, s.result.unit);
          },
          nb::arg("path"), "Writes a VTP file. Raises IoError.");
  module.def("surface", &make_py_surface, nb::arg("state"), nb::arg("settings"), nb::arg("regularize"),
             nb::arg("progress").none());
}

}  // namespace espdiff::python
