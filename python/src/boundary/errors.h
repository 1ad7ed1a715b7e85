// errors.h: our errors as Python's exceptions.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the exceptions to the module: Error, and one below it for each class; and translates what is thrown.
void add_errors(nanobind::module_& module);

}  // namespace espdiff::python
