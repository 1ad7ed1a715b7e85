// endpoint.cpp: converts Tcl's descriptions of molecules and maps.
#include "endpoint.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>

#include "averaged_endpoint.h"
#include "base/error.h"
#include "base/vector.h"
#include "field/given_values.h"
#include "io/grids/read_dx.h"
#include "io/grids/read_grid.h"
#include "io/molecules/molecule_builder.h"
#include "potential/potential.h"
#include "tcl_values.h"
#include "vmdplugin/bridge/fingerprint.h"
#include "vmdplugin/bridge/molfile_bridge.h"
#include "whole_molecule.h"

namespace espdiff::vmdplugin {
namespace {

ValueOrigin origin_named(const std::string& name, const std::string& what) {
  if (name == "file") return ValueOrigin::kFile;
  if (name == "vmd") return ValueOrigin::kVmd;
  if (name == "element") return ValueOrigin::kElement;
  if (name == "none") return ValueOrigin::kNone;
  throw InputError(what + ": '" + name + "' is not file, vmd, element or none");
}

/// The coordinates that VMD's `gettimestep` returns: single precision, x y z of every atom.
std::vector<Vec3f> positions_of(Tcl_Obj* bytes, const std::string& name) {
  int n_bytes = 0;
  const unsigned char* const start = Tcl_GetByteArrayFromObj(bytes, &n_bytes);
  constexpr int kBytesPerAtom = 3 * sizeof(float);
  if (start == nullptr || n_bytes % kBytesPerAtom != 0)
    throw InputError(name + ": " + std::to_string(n_bytes) +
                     " bytes of coordinates are not three floats for each atom");
  std::vector<Vec3f> positions(static_cast<std::size_t>(n_bytes / kBytesPerAtom));
  if (!positions.empty()) std::memcpy(positions.data(), start, static_cast<std::size_t>(n_bytes));
  return positions;
}

/// One element of `atoms`: {name resname resid insertion chain segname element radius charge}.
struct VmdAtom {
  AtomEntry entry;
  double radius, charge;
};

VmdAtom atom_of(Tcl_Obj* description, const std::string& what) {
  const std::vector<Tcl_Obj*> fields = to_vector(description, what);
  constexpr std::size_t kFields = 9;
  if (fields.size() != kFields)
    throw InputError(what + " has " + std::to_string(fields.size()) + " fields instead of " + std::to_string(kFields));
  VmdAtom atom{};
  atom.entry.name = to_string(fields[0]);
  atom.entry.residue_name = to_string(fields[1]);
  atom.entry.residue_number = to_int(fields[2], what + ", resid");
  const std::string insertion = to_string(fields[3]), chain = to_string(fields[4]), segment = to_string(fields[5]);
  atom.entry.insertion_code = insertion.empty() ? ' ' : insertion[0];
  // VMD calls a missing chain "X"; then the segment identifies the chain.
  const bool has_chain = !chain.empty() && chain != " " && chain != "X";
  atom.entry.chain = has_chain || segment.empty() ? chain : segment;
  // VMD calls an unknown element "X"; then it follows from the atom's name.
  atom.entry.element = to_string(fields[6]) == "X" ? "" : to_string(fields[6]);
  atom.radius = to_double(fields[7], what + ", radius");
  atom.charge = to_double(fields[8], what + ", charge");
  return atom;
}

/// Values of fields, of all atoms in the coordinates; those of the molecule's are kept.
/// @param places [atom of the molecule] in the coordinates
void take_given_values(Tcl_Obj* description, const std::vector<std::size_t>& places, std::size_t n_coordinates,
                       const std::string& role, State& state) {
  const std::vector<Tcl_Obj*> pairs = to_vector(description, role + " values");
  auto given = std::make_shared<GivenValues>(state.molecule);
  for (std::size_t k = 0; k + 1 < pairs.size(); k += 2) {
    const std::string name = to_string(pairs[k]), what = state.molecule.name + ", " + name;
    const std::vector<Tcl_Obj*> all = to_vector(pairs[k + 1], what);
    if (all.size() != n_coordinates)
      throw InputError(what + ": " + std::to_string(all.size()) + " values for " + std::to_string(n_coordinates) +
                       " atoms");
    std::vector<float> values;
    for (const std::size_t place : places) values.push_back(static_cast<float>(to_double(all[place], what)));
    given->add(name, std::move(values));
  }
  state.given = std::move(given);
}

void parse_vmd_molecule(DictReader& reader, const std::string& role, State& state) {
  const std::string name = reader.text("name", role);
  const std::vector<Tcl_Obj*> atoms = to_vector(reader.require("atoms"), role + " atoms");
  const std::vector<Vec3f> positions = positions_of(reader.require("coordinates"), name);
  std::vector<Tcl_Obj*> indices;
  if (Tcl_Obj* const list = reader.find("indices")) {
    indices = to_vector(list, role + " indices");
    if (indices.size() != atoms.size())
      throw InputError(name + ": " + std::to_string(indices.size()) + " indices for " + std::to_string(atoms.size()) +
                       " atoms");
  } else if (positions.size() != atoms.size()) {
    throw InputError(name + ": " + std::to_string(positions.size()) + " coordinates for " +
                     std::to_string(atoms.size()) + " atoms");
  }
  const ValueOrigin radii = origin_named(reader.text("radii_origin", "vmd"), "radii_origin");
  const ValueOrigin charges = origin_named(reader.text("charges_origin", "none"), "charges_origin");
  MoleculeBuilder builder(name, {});
  std::vector<float> charge;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const std::string what = name + ", atom " + std::to_string(i);
    VmdAtom atom = atom_of(atoms[i], what);
    const std::size_t at = indices.empty() ? i : static_cast<std::size_t>(to_int(indices[i], what));
    if (at >= positions.size())
      throw InputError(what + ": there are coordinates of " + std::to_string(positions.size()) + " atoms only");
    atom.entry.position = static_cast<Vec3d>(positions[at]);
    places.push_back(at);
    charge.push_back(static_cast<float>(atom.charge));
    if (radii == ValueOrigin::kElement) {
      builder.add(atom.entry);
    } else {
      builder.add(atom.entry, atom.charge, atom.radius);
    }
  }
  Molecule& molecule = state.molecule;
  molecule = builder.finish();
  molecule.radii_origin = radii;
  molecule.charges = charges == ValueOrigin::kFile ? charge : std::vector<float>();
  if (std::none_of(molecule.radii.begin(), molecule.radii.end(), [](float r) { return r > 0; }))
    throw InputError(name +
                     ": every radius is 0, so that there is no surface; load a file with radii (PQR), set them "
                     "(`$sel set radius`), or take `radii element`");
  std::string input = reader.text("input", name);
  const bool whole = reader.boolean("whole", false);
  if (Tcl_Obj* const numbers = reader.find("cell")) {
    const std::optional<UnitCell> cell = parse_unit_cell(numbers, role + " cell");
    if (cell && make_whole(molecule, *cell, whole, role) > 0) input += " whole 1";
  }
  state.is_selected = true;
  state.input = {{}, input, fingerprint(molecule)};
  if (Tcl_Obj* const values = reader.find("values")) take_given_values(values, places, positions.size(), role, state);
  if (Tcl_Obj* const list = reader.find("region")) {
    std::set<std::size_t> chosen;
    for (Tcl_Obj* const index : to_vector(list, role + " region"))
      chosen.insert(static_cast<std::size_t>(to_int(index, role + " region")));
    state.region.assign(molecule.residues.size(), 0);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      const std::size_t at = indices.empty() ? i : static_cast<std::size_t>(to_int(indices[i], "index"));
      if (chosen.count(at) > 0) state.region[static_cast<std::size_t>(molecule.atoms[i].residue)] = 1;
    }
  }
}

/// @param endpoint_reader of the map's endpoint, which has the coordinates and the cell
void parse_potential(DictReader& reader, DictReader& endpoint_reader, const std::string& role, State& state) {
  StatePotential request;
  request.method = parse_potential_method(to_string(reader.require("kind")));
  request.because = reader.text("because");
  request.given = take_potential_settings(reader);
  make_potential_options(request.method, request.given, PmeOptions().temperature_K);  // reports a wrong one at once
  if (Tcl_Obj* const box = reader.find("box")) {
    if (request.method != PotentialMethod::kPme)
      throw InputError(role + " map: a cell was given, and only the potential pme has one; leave it out");
    request.cell = parse_cell(to_string(box));
  }
  if (Tcl_Obj* const charges = reader.find("charges")) {
    const std::string name = endpoint_reader.text("name", role);
    request.charges = charged_atoms(charges, endpoint_reader.require("coordinates"), name);
    for (Tcl_Obj* const radius : to_vector(reader.require("radii"), name + ", radii"))
      request.charges.radii.push_back(static_cast<float>(to_double(radius, name + ", radius")));
    if (request.charges.radii.size() != request.charges.size())
      throw InputError(name + ": " + std::to_string(request.charges.radii.size()) + " radii for " +
                       std::to_string(request.charges.size()) + " atoms");
    request.surroundings.has_water = reader.boolean("water", false);
    require_charges(request.charges);
  }
  if (Tcl_Obj* const cell = endpoint_reader.find("cell"))
    request.surroundings.cell = parse_unit_cell(cell, role + " cell");
  reader.finish();
  state.potential = std::move(request);
}

/// Whether a lattice repeats with the cell: its points cover each edge once, as those of PME's maps do. A lattice that
/// ends at the cell's border has a point more.
bool covers_cell(const Lattice& lattice, const UnitCell& cell) {
  constexpr double kDegree = kPi / 180;
  const auto edge = [&](std::size_t axis) { return static_cast<double>(lattice.size[axis]) * lattice.step[axis]; };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::fabs(norm(edge(axis)) - cell.lengths[static_cast<int>(axis)]) > 0.3 * norm(lattice.step[axis]))
      return false;
    const Vec3d b = edge((axis + 1) % 3), c = edge((axis + 2) % 3);
    const double cosine = dot(b, c) / (norm(b) * norm(c));
    if (std::fabs(cosine - std::cos(kDegree * cell.angles[static_cast<int>(axis)])) > 0.01) return false;
  }
  return true;
}

void parse_map(Tcl_Obj* description, DictReader& endpoint_reader, const std::string& role, State& state) {
  DictReader reader(description, role + " map");
  if (reader.find("kind") != nullptr) return parse_potential(reader, endpoint_reader, role, state);
  state.map_unit = reader.text("unit");
  if (Tcl_Obj* const memory = reader.find("memory")) {
    const std::string name = to_string(memory), label = reader.text("name", name);
    if (reader.find("mean_over") != nullptr) return take_averaged_map(reader, name, role, state);
    reader.finish();
    std::optional<Grid> map = take_volume(name);
    if (!map) throw InputError(role + " map: no volume named '" + name + "' is in memory");
    map->name = label;
    map->contradicting_title = title_of_other_quantity(label);
    if (!state.map_unit.empty()) take_unit(state.map_unit, *map);
    if (Tcl_Obj* const numbers = endpoint_reader.find("cell")) {
      const std::optional<UnitCell> cell = parse_unit_cell(numbers, role + " cell");
      if (cell && covers_cell(map->lattice, *cell)) map->periodic = true;
    }
    state.map_input = {{}, label, fingerprint(*map)};
    state.map = std::make_shared<const Grid>(std::move(*map));
    return;
  }
  state.map_path = to_string(reader.require("file"));
  state.map_array = reader.text("array");
  reader.find("name");
  reader.finish();
  if (!state.map_unit.empty()) parse_potential_unit(state.map_unit);  // reports a wrong one at once
}

}  // namespace

State parse_endpoint(Tcl_Obj* description, const std::string& role) {
  State state;
  DictReader reader(description, role);
  if (Tcl_Obj* const path = reader.find("file")) {
    state.path = to_string(path);
    state.structure.model = reader.integer("model", 1);
    state.structure.include_hetero = reader.boolean("hetero", true);
    state.structure.include_water = reader.boolean("water", false);
  } else {
    parse_vmd_molecule(reader, role, state);
  }
  reader.find("cell");
  if (Tcl_Obj* const map = reader.find("map")) parse_map(map, reader, role, state);
  state.shapes_because = reader.text("shapes_because");
  reader.finish();
  return state;
}

StatePtr shared_endpoint(Tcl_Obj* description, const std::string& role) {
  return std::make_shared<const State>(parse_endpoint(description, role));
}

GivenPotentialSettings take_potential_settings(DictReader& reader) {
  GivenPotentialSettings given;
  for (const PotentialSetting& setting : potential_settings()) {
    Tcl_Obj* const value = reader.find(setting.key.c_str());
    if (value == nullptr) continue;
    const bool is_boolean = setting.kind == SettingKind::kBoolean;
    given.emplace_back(setting.key, is_boolean ? (to_bool(value, setting.key) ? "1" : "0") : to_string(value));
  }
  return given;
}

std::optional<UnitCell> parse_unit_cell(Tcl_Obj* numbers, const std::string& what) {
  const std::vector<Tcl_Obj*> values = to_vector(numbers, what);
  if (values.size() != 6)
    throw InputError(what + ": " + std::to_string(values.size()) +
                     " numbers instead of three lengths and three angles");
  UnitCell cell;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    cell.lengths[axis] = to_double(values[i], what);
    cell.angles[axis] = to_double(values[i + 3], what);
    if (cell.lengths[axis] <= 1) return std::nullopt;
  }
  return cell;
}

Molecule charged_atoms(Tcl_Obj* charges, Tcl_Obj* coordinates, const std::string& name) {
  const std::vector<Vec3f> positions = positions_of(coordinates, name);
  const std::vector<Tcl_Obj*> values = to_vector(charges, name + ", charges");
  if (values.size() != positions.size())
    throw InputError(name + ": " + std::to_string(values.size()) + " charges for " + std::to_string(positions.size()) +
                     " atoms");
  Molecule molecule;
  molecule.name = name;
  molecule.positions.reserve(positions.size());
  molecule.charges.reserve(positions.size());
  const std::string what = name + ", charge";
  for (std::size_t i = 0; i < positions.size(); ++i) {
    molecule.positions.push_back(static_cast<Vec3d>(positions[i]));
    molecule.charges.push_back(static_cast<float>(to_double(values[i], what)));
  }
  return molecule;
}

Molecule named_atoms(const std::vector<Tcl_Obj*>& atoms, const std::vector<Vec3d>& positions, const std::string& name) {
  if (atoms.size() != positions.size())
    throw InputError(name + ": " + std::to_string(atoms.size()) + " names for " + std::to_string(positions.size()) +
                     " atoms");
  MoleculeBuilder builder(name, {});
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    VmdAtom atom = atom_of(atoms[i], name + ", atom " + std::to_string(i));
    atom.entry.position = positions[i];
    builder.add(atom.entry);
  }
  return builder.finish();
}

}  // namespace espdiff::vmdplugin
