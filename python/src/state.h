// state.h: one state of a molecule: from a file, or from arrays.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>
#include <string>

#include "base/structure_options.h"
#include "base/types.h"
#include "base/unit_cell.h"
#include "report/provenance.h"

namespace espdiff {
class GivenValues;
class StructureFile;
}  // namespace espdiff

namespace espdiff::python {

/// A molecule, what surrounds it, and its map where one is given. Never changed once it is made: computations on other
/// threads share it.
struct State {
  Molecule molecule;                          ///< as it was read or given, before selections and charges
  std::shared_ptr<const StructureFile> file;  ///< null for one of arrays
  StructureOptions structure;                 ///< how the file is read
  /// Of arrays: with water and ions, where pme is to count their charges; null: the molecule alone.
  std::shared_ptr<const Molecule> everything;
  std::optional<UnitCell> cell;  ///< of arrays
  std::shared_ptr<const Grid> map;
  InputFile input, map_input;  ///< without roles
  std::string preparation;     ///< what PDB2PQR did, as in OUT.json; empty where it did not run
  bool map_from_file = false;
  std::string map_array;                     ///< of a file that has several
  std::shared_ptr<const GivenValues> given;  ///< values of the atoms for fields; null for none
};

using StatePtr = std::shared_ptr<const State>;

/// Names a state that is of no structure file by its molecule, with a fingerprint of all that a result depends on.
void note_input(State& state);

/// Adds the class State.
void add_state(nanobind::module_& module);

}  // namespace espdiff::python
