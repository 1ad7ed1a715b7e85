// state_parts.cpp: takes a State apart.
#include "state_parts.h"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <utility>
#include <vector>

#include "base/units.h"
#include "field/given_values.h"
#include "python/src/boundary/arrays.h"

namespace espdiff::python {
namespace {

std::vector<double> coordinates(const Molecule& molecule) {
  std::vector<double> all;
  all.reserve(3 * molecule.size());
  for (const Vec3d& p : molecule.positions) all.insert(all.end(), {p.x, p.y, p.z});
  return all;
}

nb::dict arrays_of(const Molecule& molecule, const std::optional<UnitCell>& cell) {
  std::vector<std::string> names, elements, residue_names, chains, codes;
  std::vector<int> numbers;
  for (const Atom& atom : molecule.atoms) {
    const Residue& residue = molecule.residues[static_cast<std::size_t>(atom.residue)];
    names.push_back(atom.name);
    elements.push_back(atom.element);
    residue_names.push_back(residue.name);
    chains.push_back(residue.chain);
    codes.push_back(residue.insertion_code == ' ' ? std::string() : std::string(1, residue.insertion_code));
    numbers.push_back(residue.number);
  }
  nb::dict arrays;
  arrays["positions"] = nb::object(array_from(coordinates(molecule)).attr("reshape")(-1, 3));
  if (molecule.radii_origin == ValueOrigin::kFile) arrays["radii"] = array_from(molecule.radii);
  if (!molecule.charges.empty()) arrays["charges"] = array_from(molecule.charges);
  arrays["names"] = names;
  arrays["elements"] = elements;
  arrays["residue_names"] = residue_names;
  arrays["residue_numbers"] = numbers;
  arrays["chains"] = chains;
  arrays["insertion_codes"] = codes;
  if (cell) {
    const auto& [lengths, angles] = *cell;
    arrays["cell"] =
        array_from(std::vector<double>{lengths[0], lengths[1], lengths[2], angles[0], angles[1], angles[2]});
  }
  arrays["name"] = molecule.name;
  return arrays;
}

nb::tuple map_of(const Grid& grid) {
  // As the grid has it: x fastest.
  const auto n = [&](std::size_t axis) { return grid.lattice.size[axis]; };
  const nb::object values = array_from(grid.values).attr("reshape")(n(2), n(1), n(0)).attr("transpose")();
  const auto& [o, s] = std::pair(grid.lattice.origin, grid.lattice.step);
  return nb::make_tuple(values, std::vector<double>{o.x, o.y, o.z}, std::vector<double>{s[0].x, s[1].y, s[2].z},
                        to_string(grid.unit));
}

}  // namespace

nb::dict parts_of(const State& state) {
  nb::dict parts;
  if (state.file != nullptr) {
    parts["path"] = state.input.path;
    parts["model"] = state.structure.model;
    parts["hetero"] = state.structure.include_hetero;
    parts["water"] = state.structure.include_water;
    parts["sha256"] = state.input.sha256;
  } else {
    parts["arrays"] = arrays_of(state.molecule, state.cell);
  }
  if (!state.preparation.empty()) parts["preparation"] = state.preparation;
  if (state.given != nullptr) {
    nb::dict values;
    for (const std::string& name : state.given->names())
      values[name.c_str()] = array_from(state.given->values_of(name, state.molecule));
    parts["values"] = values;
  }
  if (state.everything != nullptr) {
    parts["everything"] = arrays_of(*state.everything, state.cell);
  }
  if (state.map == nullptr) return parts;
  if (!state.map_path.empty()) {
    parts["map_path"] = state.map_input.path;
    parts["unit"] = to_string(state.map->unit);
    parts["array"] = state.map_array;
  } else {
    parts["map"] = map_of(*state.map);
  }
  return parts;
}

}  // namespace espdiff::python
