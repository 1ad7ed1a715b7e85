// matrix.h: every state with every other one.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the function matrix().
void add_matrix(nanobind::module_& module);

}  // namespace espdiff::python
