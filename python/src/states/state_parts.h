// state_parts.h: a State as Python's values, from which another process makes the same one.
#pragma once

#include <nanobind/nanobind.h>

#include "state.h"

namespace espdiff::python {

/// For `_inputs._rebuild`: path, model, hetero, water and sha256 of one from a file, otherwise arrays (the arguments of
/// State.from_arrays); everything (arguments of from_arrays, too), map_path with unit and array, or map (values,
/// origin, step, unit), where it has them.
nanobind::dict parts_of(const State& state);

}  // namespace espdiff::python
