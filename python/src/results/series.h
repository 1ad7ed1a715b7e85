// series.h: many targets against one source.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the class Series.
void add_series(nanobind::module_& module);

}  // namespace espdiff::python
