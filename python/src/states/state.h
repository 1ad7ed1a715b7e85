// state.h: one state of a molecule: from a file, or from arrays.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>

#include "study/state.h"

namespace espdiff::python {

/// A state of a study, and what PDB2PQR did. Never changed once it is made: computations on other threads share it.
struct State : espdiff::State {
  std::string preparation;  ///< as in OUT.json; empty where it did not run
};

using StatePtr = std::shared_ptr<const State>;

/// Names a state that is of no structure file by its molecule, with a fingerprint of all that a result depends on.
void note_input(State& state);

/// Adds the class State.
void add_state(nanobind::module_& module);

}  // namespace espdiff::python
