// state.cpp: states from files and from arrays, checked argument by argument.
#include "state.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/formatted.h"
#include "field/given_values.h"
#include "io/files/atomic_file.h"
#include "io/files/sha256.h"
#include "io/molecules/elements.h"
#include "io/molecules/molecule_builder.h"
#include "io/molecules/select_atoms.h"
#include "io/molecules/write_pqr.h"
#include "io/structures/structure_file.h"
#include "prepare/load_state.h"
#include "python/src/boundary/arrays.h"
#include "state_parts.h"

namespace espdiff::python {
namespace {

template <typename T>
void add_values(Sha256& sum, const std::vector<T>& values) {
  sum.update(values.data(), values.size() * sizeof(T));
}

void add_text(Sha256& sum, const std::string& text) { sum.update(text.data(), text.size()); }

/// Of all that a result depends on. Positions, radii and charges have no padding.
std::string fingerprint(const Molecule& molecule) {
  Sha256 sum;
  add_values(sum, molecule.positions);
  add_values(sum, molecule.radii);
  add_values(sum, molecule.charges);
  for (const Atom& atom : molecule.atoms) add_text(sum, atom.name + "\n" + std::to_string(atom.residue) + "\n");
  for (const Residue& residue : molecule.residues) {
    add_text(sum, residue.chain + "\n" + residue.name + "\n" + std::to_string(residue.number) + residue.insertion_code +
                      "\n");
  }
  return sum.finish();
}

template <typename T>
void check_size(const std::vector<T>& values, const char* name, std::size_t n) {
  if (values.empty() || values.size() == n) return;
  throw InputError(std::string(name) + ": there are " + std::to_string(values.size()) + " for " + std::to_string(n) +
                   " atoms");
}

std::optional<UnitCell> read_cell(const std::optional<AnyArray>& numbers) {
  if (!numbers) return std::nullopt;
  if (numbers->size() != 6)
    throw InputError("cell: " + std::to_string(numbers->size()) +
                     " numbers; three lengths (A) and three angles (degrees) are needed");
  const std::vector<float> v = read_values(*numbers, "cell");
  for (const float value : v) {
    if (!std::isfinite(value)) throw InputError("cell: a length or angle is not finite");
  }
  const auto d = [&](std::size_t i) { return static_cast<double>(v[i]); };
  if (d(0) <= 1 || d(1) <= 1 || d(2) <= 1) return std::nullopt;
  return UnitCell{{d(0), d(1), d(2)}, {d(3), d(4), d(5)}};
}

/// What the binding's own error would put in its words.
template <typename T>
T taken(nb::handle given, const char* name, const char* wanted) {
  try {
    return nb::cast<T>(given);
  } catch (const std::bad_cast&) {
    throw InputError(std::string(name) + ": a " + nb::cast<std::string>(given.type().attr("__name__")) + " is no " +
                     wanted);
  }
}

std::optional<AnyArray> taken_array(nb::handle given, const char* name) {
  if (given.is_none()) return std::nullopt;
  return taken<AnyArray>(given, name, "array of numbers; give numpy.asarray(..., dtype=float)");
}

std::vector<std::string> taken_texts(nb::handle given, const char* name) {
  return taken<std::vector<std::string>>(given, name, "list of texts, one for each atom");
}

/// Numbers of atoms within the limits that readers of files have.
void check_limits(const std::vector<float>& values, const std::string& name, double least, double most,
                  const char* unit) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = static_cast<double>(values[i]);
    if (value < least || value > most)
      throw InputError(name + ": atom " + std::to_string(i) + " has " + formatted("%g", value) + " " + unit +
                       "; between " + formatted("%g", least) + " and " + formatted("%g", most) + " is taken");
  }
}

/// Names and residues as a structure file would have them.
struct Labels {
  std::vector<std::string> names, elements, residue_names, chains, insertion_codes;
  std::vector<int> residue_numbers;
};

StatePtr from_arrays(const AnyArray& positions, const std::optional<AnyArray>& rows,
                     const std::optional<AnyArray>& radii, const std::optional<AnyArray>& charges, Labels labels,
                     const std::optional<AnyArray>& cell, const std::string& name) {
  auto state = std::make_shared<State>();
  const PositionRows at(positions, rows, "positions");
  const std::size_t n = at.size();
  check_size(labels.names, "names", n);
  check_size(labels.elements, "elements", n);
  check_size(labels.residue_names, "residue_names", n);
  check_size(labels.residue_numbers, "residue_numbers", n);
  check_size(labels.chains, "chains", n);
  check_size(labels.insertion_codes, "insertion_codes", n);
  if (!radii && labels.names.empty() && labels.elements.empty())
    throw InputError("radii: none are given, and neither names nor elements to take them from");
  MoleculeBuilder builder(name, {});
  builder.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    AtomEntry entry;
    // Atoms without names pair by their places in the arrays.
    entry.name = labels.names.empty() ? "A" + std::to_string(i + 1) : labels.names[i];
    if (!labels.elements.empty()) entry.element = labels.elements[i];
    entry.residue_name = labels.residue_names.empty() ? "MOL" : labels.residue_names[i];
    entry.residue_number = labels.residue_numbers.empty() ? 1 : labels.residue_numbers[i];
    if (!labels.chains.empty()) entry.chain = labels.chains[i];
    if (!labels.insertion_codes.empty() && !labels.insertion_codes[i].empty())
      entry.insertion_code = labels.insertion_codes[i][0];
    entry.position = at[i];
    builder.add(entry);
  }
  state->molecule = builder.finish();
  if (radii) {
    state->molecule.radii = read_numbers(*radii, "radii", n);
    state->molecule.radii_origin = ValueOrigin::kFile;
    for (std::size_t i = 0; i < n; ++i) {
      if (state->molecule.radii[i] < 0) throw InputError("radii: atom " + std::to_string(i) + " has a negative radius");
    }
    check_limits(state->molecule.radii, "radii", 0, kLargestRadius_A, "A");
  }
  if (charges) {
    state->molecule.charges = read_numbers(*charges, "charges", n);
    check_limits(state->molecule.charges, "charges", -kLargestCharge, kLargestCharge, "e");
  }
  state->cell = read_cell(cell);
  note_input(*state);
  return state;
}

StatePtr from_file(const std::filesystem::path& path, int model, bool hetero, bool water) {
  auto state = std::make_shared<State>();
  state->path = path.string();
  state->file = std::make_shared<const StructureFile>(state->path);
  state->structure = {model, hetero, water, {}};
  state->molecule = read_as_it_is(*state->file, state->structure);
  state->input = {"", path.string(), state->file->sha256(), nullptr, state->structure};
  return state;
}

/// A copy with what surrounds the molecule: the water, ions and cell of another state.
StatePtr surrounded_by(const State& state, const StatePtr& everything) {
  if (state.file != nullptr)
    throw InputError(state.molecule.name + ": the surroundings of a state from a file are in its file");
  auto copy = std::make_shared<State>(state);
  copy->everything = std::shared_ptr<const Molecule>(everything, &everything->molecule);
  copy->cell = everything->cell;
  copy->input.sha256 = sha256_of(state.input.sha256 + everything->input.sha256);
  return copy;
}

StatePtr without_water(const State& state) {
  auto copy = std::make_shared<State>(state);
  copy->molecule = keep_kinds(state.molecule, {1, true, false, {}});
  note_input(*copy);
  return copy;
}

StatePtr with_preparation(const State& state, const std::string& json) {
  auto copy = std::make_shared<State>(state);
  copy->preparation = json;
  return copy;
}

void save_pqr(const State& state, const std::filesystem::path& path) {
  if (state.molecule.charges.empty() || state.molecule.radii.empty())
    throw InputError(state.molecule.name +
                     ": a PQR file has charges and radii, and the state lacks them; "
                     "espdiff.prepare(state) adds them");
  const nb::gil_scoped_release unlocked;
  AtomicFile file(path.string());
  write_pqr(file.stream(), state.molecule);
  file.commit();
}

StatePtr with_map_file(const State& state, const std::string& path, const std::string& unit, const std::string& array) {
  auto copy = std::make_shared<State>(state);
  copy->map = nullptr;
  copy->map_path = path;
  copy->map_array = array;
  copy->map_unit = unit;
  read_given_map(*copy);
  return copy;
}

/// A copy with values of its atoms, for the field `given:NAME`. NaN: the atom has none.
/// @param of the state whose atoms the values are of, where this one lacks some; null: itself
StatePtr with_values(const State& state, const std::string& name, const std::vector<float>& values,
                     const StatePtr& of) {
  auto copy = std::make_shared<State>(state);
  auto given = state.given != nullptr ? std::make_shared<GivenValues>(*state.given)
                                      : std::make_shared<GivenValues>(of != nullptr ? of->molecule : state.molecule);
  given->add(name, values);
  copy->given = std::move(given);
  return copy;
}

StatePtr with_map(const State& state, const AnyArray& values, const std::vector<double>& origin,
                  const std::vector<double>& step, const std::string& unit) {
  if (values.ndim() != 3) throw InputError("values: a map has three axes, x, y and z");
  if (origin.size() != 3) throw InputError("origin: three numbers (A) are needed");
  if (step.size() != 3) throw InputError("step: three numbers (A), one for each axis, are needed");
  auto grid = std::make_shared<Grid>();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (values.shape(axis) < 2 || values.shape(axis) > 4096)
      throw InputError("values: an axis has " + std::to_string(values.shape(axis)) + " points; 2 to 4096 are possible");
    if (!(step[axis] > 0)) throw InputError("step: " + std::to_string(step[axis]) + " A is not positive");
    grid->lattice.size[axis] = static_cast<int>(values.shape(axis));
    grid->lattice.step[axis][static_cast<int>(axis)] = step[axis];
    grid->lattice.origin[static_cast<int>(axis)] = origin[axis];
  }
  const std::vector<float> in_order = read_values(values, "values");  // z fastest
  const std::size_t nx = values.shape(0), ny = values.shape(1), nz = values.shape(2);
  grid->values.resize(in_order.size());
  for (std::size_t x = 0; x < nx; ++x) {
    for (std::size_t y = 0; y < ny; ++y) {
      for (std::size_t z = 0; z < nz; ++z) {
        const float value = in_order[z + nz * (y + ny * x)];
        if (!std::isfinite(value)) throw InputError("values: the map has values that are not finite");
        grid->values[x + nx * (y + ny * z)] = value;
      }
    }
  }
  grid->unit = parse_potential_unit(unit);
  grid->name = "map of " + state.molecule.name;
  Sha256 sum;
  add_values(sum, grid->values);
  auto copy = std::make_shared<State>(state);
  copy->map_input = {"", grid->name, sum.finish()};
  copy->map = grid;
  copy->map_path.clear();
  return copy;
}

}  // namespace

void note_input(State& state) { state.input = {"", state.molecule.name, fingerprint(state.molecule)}; }

void add_state(nb::module_& module) {
  nb::class_<State>(module, "State",
                    "One state of a molecule: positions, radii and charges of its atoms, with their names and "
                    "residues, by which the atoms of two states are paired. Read-only.")
      .def_static("read", &from_file, nb::arg("path"), nb::kw_only(), nb::arg("model") = 1, nb::arg("hetero") = true,
                  nb::arg("water") = false,
                  "Reads a PQR, PDB, mmCIF, GRO, MOL2 or Amber restart file (also packed by gzip).\n\n"
                  "model: which of the file's models, from 1. hetero: keep HETATM records. water: keep water as part "
                  "of the molecule; it counts for pme in a periodic cell in any case.\n"
                  "Raises IoError, FormatError, InputError.")
      .def_static(
          "from_arrays",
          [](nb::object positions, nb::object radii, nb::object charges, nb::object rows, nb::object names,
             nb::object elements, nb::object residue_names, nb::object residue_numbers, nb::object chains,
             nb::object insertion_codes, nb::object cell, nb::object name) {
            const std::optional<AnyArray> places = taken_array(positions, "positions");
            if (!places) throw InputError("positions: none are given");
            return from_arrays(*places, taken_array(rows, "rows"), taken_array(radii, "radii"),
                               taken_array(charges, "charges"),
                               {taken_texts(names, "names"), taken_texts(elements, "elements"),
                                taken_texts(residue_names, "residue_names"), taken_texts(chains, "chains"),
                                taken_texts(insertion_codes, "insertion_codes"),
                                taken<std::vector<int>>(residue_numbers, "residue_numbers",
                                                        "list of whole numbers, one for each atom")},
                               taken_array(cell, "cell"), taken<std::string>(name, "name", "text"));
          },
          nb::arg("positions").none(), nb::arg("radii").none() = nb::none(), nb::arg("charges").none() = nb::none(),
          nb::kw_only(), nb::arg("rows").none() = nb::none(), nb::arg("names") = nb::list(),
          nb::arg("elements") = nb::list(), nb::arg("residue_names") = nb::list(),
          nb::arg("residue_numbers") = nb::list(), nb::arg("chains") = nb::list(),
          nb::arg("insertion_codes") = nb::list(), nb::arg("cell").none() = nb::none(), nb::arg("name") = "arrays",
          "A state from arrays, which are copied once, in any floating-point type and order.\n\n"
          "positions: (n, 3), A; with rows, (m) integers, those rows of it, such as an AtomGroup's of its universe's. "
          "radii: (n), A; without, van der Waals radii by element. charges: (n), elementary "
          "charges; without, shapes alone are compared. cell: three lengths (A), three angles (degrees).\n"
          "Raises InputError, which names the argument.")
      .def("surrounded_by", &surrounded_by, nb::arg("everything"),
           "The same molecule in the surroundings of another state: its water and ions (which count for pme) and its "
           "cell.")
      .def("with_map", &with_map_file, nb::arg("path"), nb::kw_only(), nb::arg("unit") = "", nb::arg("array") = "",
           "The same molecule with the potential of a map file: DX, VTI or cube.")
      .def("with_map", &with_map, nb::arg("values"), nb::arg("origin"), nb::arg("step"), nb::arg("unit") = "kT/e",
           "The same molecule with a potential: values (nx, ny, nz), origin and step in A.")
      .def("_with_values", &with_values, nb::arg("name"), nb::arg("values"), nb::arg("of").none() = nb::none(),
           "The same molecule with values of its atoms for the field given:NAME.")
      .def("without_water", &without_water, "The same atoms without water, as files are read.")
      .def("save", &save_pqr, nb::arg("path"), "Writes a PQR file; raises IoError, and InputError without charges.")
      .def_prop_ro(
          "preparation",
          [](const State& s) -> nb::object {
            if (s.preparation.empty()) return nb::none();
            return nb::module_::import_("json").attr("loads")(s.preparation);
          },
          "What PDB2PQR did: the dict of OUT.json; None where it did not run.")
      .def("_with_preparation", &with_preparation)
      .def("_parts", &parts_of, "What another process makes the same state of.")
      .def("__len__", [](const State& s) { return s.molecule.size(); })
      .def("__repr__",
           [](const State& s) {
             return "<espdiff.State " + s.molecule.name + ": " + std::to_string(s.molecule.size()) + " atoms, " +
                    std::to_string(s.molecule.residues.size()) + " residues" +
                    (s.molecule.charges.empty() ? ", no charges>" : ">");
           })
      .def_prop_ro(
          "name", [](const State& s) { return s.molecule.name; }, "Path or name, for messages.")
      .def_prop_ro(
          "sha256", [](const State& s) { return s.input.sha256; }, "Of the file or of the arrays.")
      .def_prop_ro(
          "positions", [](nb::handle self) { return view_of(nb::cast<const State&>(self).molecule.positions, self); },
          "(n, 3) float64, A; read-only.")
      .def_prop_ro(
          "radii", [](nb::handle self) { return view_of(nb::cast<const State&>(self).molecule.radii, self); },
          "(n) float32, A; read-only.")
      .def_prop_ro(
          "charges", [](nb::handle self) { return view_of(nb::cast<const State&>(self).molecule.charges, self); },
          "(n) float32, elementary charges; empty without charges; read-only.");
}

}  // namespace espdiff::python
