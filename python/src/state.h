// state.h: one state of a molecule: from a file, or from arrays.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>
#include <string>

#include "base/types.h"
#include "base/unit_cell.h"
#include "report/provenance.h"

namespace espdiff::python {

/// A molecule, what surrounds it, and its map where one is given. Never changed once it is made: computations on other
/// threads share it.
struct State {
  Molecule molecule;  ///< what has the surface
  /// With water and ions, where pme is to count their charges; null: the molecule alone.
  std::shared_ptr<const Molecule> everything;
  std::optional<UnitCell> cell;
  std::shared_ptr<const Grid> map;
  InputFile input, map_input;  ///< without roles

  const Molecule& all() const { return everything != nullptr ? *everything : molecule; }
};

using StatePtr = std::shared_ptr<const State>;

/// Adds the class State.
void add_state(nanobind::module_& module);

}  // namespace espdiff::python
