// prepare.h: states that get charges without being compared.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the function prepare().
void add_prepare(nanobind::module_& module);

}  // namespace espdiff::python
