// ensemble.h: groups of simulations, mapped from one template.
#pragma once

#include <nanobind/nanobind.h>

namespace espdiff::python {

/// Adds the class Ensemble and the functions ensemble() and merge_ensemble(); without HDF5 they say that it is missing.
void add_ensemble(nanobind::module_& module);

}  // namespace espdiff::python
