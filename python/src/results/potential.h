// potential.h: potential maps.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the class Map and the function potential().
void add_potential(nanobind::module_& module);

}  // namespace espdiff::python
