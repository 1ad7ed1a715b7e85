// field.h: a field that two states are compared by: what it is, and how it is made for a state.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/handles.h"
#include "base/molecule/quantity.h"
#include "base/types.h"
#include "engine/field_stage.h"
#include "field/field_result.h"
#include "field/field_side.h"

namespace espdiff {

/// A surface on which a field is read, in the common frame.
struct FieldPlace {
  Engine& engine;
  MeshPtr mesh;
  MeshPtr outside;  ///< the mesh moved outward by the distance at which potentials are read; maps are read there
  const Molecule& molecule;
  RigidTransform to_common;  ///< the molecule's own frame -> the common frame
  AtomsPtr atoms;            ///< of the molecule
  float isovalue = 0;
  double radius_scale = 1;
  GridPtr potential;                     ///< of the molecule; null where there is none
  std::vector<std::uint8_t> left_out{};  ///< [triangle] nonzero where the mesh is no surface; empty for none
};

/// [vertex] values on a surface; NaN where there are none.
using SurfaceReader = std::function<std::vector<float>(const FieldPlace& place)>;

/// A field of one state: values of its atoms, a map in its own frame, or a function of its surface; one of them.
struct StateField {
  std::vector<float> atoms;  ///< [atom] NaN where the atom has none
  AtomWeight weight = AtomWeight::kDensityMean;
  std::shared_ptr<const Grid> map;
  SurfaceReader on_surface;
  std::vector<std::string> notes;  ///< what a reader of the result has to know
  std::vector<FieldFile> files;    ///< that this state alone has
};

/// Makes a field of a state. @throws InputError (the state has none)
using FieldMaker = std::function<StateField(const Molecule& molecule, const FieldSide& side)>;

/// A field, as it was asked for.
struct Field {
  Quantity quantity;
  std::string what;       ///< KIND or KIND:ARGUMENT
  std::string reference;  ///< author, title, year of its values; empty for the user's own
  FieldMaker make;
  std::vector<FieldFile> files{};  ///< that all states share
  /// Made of the potential: refused where there is none; its unit is the potential's per Angstrom.
  bool of_potential = false;
};

/// A kind of field: a row of `espdiff fields`. Its file is field/kinds/NAME.cpp.
struct FieldKind {
  Quantity quantity;      ///< its name is the kind's
  std::string argument;   ///< what follows the colon: "SCALE"; in brackets where it may be missing; empty for none
  std::string help;       ///< one sentence
  std::string reference;  ///< author, title, year
  /// Makes the field; reads the files that the argument names.
  /// @throws InputError, IoError, FormatError
  std::function<Field(const FieldKind& kind, const std::string& argument)> field;
  bool needs_charges = false;  ///< or a potential: no state has it where shapes alone are compared
};

/// A kind without an argument whose values are those of atoms.
FieldKind kind_of_atoms(Quantity quantity, std::string help, std::string reference,
                        std::function<std::vector<float>(const Molecule&)> values);

/// A kind without an argument that is read from the state's potential.
FieldKind kind_of_potential(Quantity quantity, std::string help, SurfaceReader reader);

/// Gives each hydrogen without a value that of the nearest other atom of its residue that has one.
void give_to_hydrogens(const Molecule& molecule, std::vector<float>& values);

bool is_hydrogen(const Atom& atom);

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

}  // namespace espdiff
