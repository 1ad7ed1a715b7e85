// surface.h: one molecule's surface.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the class Surface and the function surface().
void add_surface(nanobind::module_& module);

}  // namespace espdiff::python
