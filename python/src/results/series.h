// series.h: many targets against one source, and runs over frames in files.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the class Series and the function trajectory().
void add_series(nanobind::module_& module);

}  // namespace espdiff::python
