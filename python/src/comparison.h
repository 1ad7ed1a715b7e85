// comparison.h: a finished comparison as Python holds it.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>

#include "compare/result.h"
#include "inputs.h"

namespace espdiff::python {

struct Comparison {
  StatePtr source, target;
  CompareOptions options;
  Provenance provenance;
  CompareResult result;
};

/// Adds the class Comparison and the function compare().
void add_comparison(nanobind::module_& module);

}  // namespace espdiff::python
