// comparison.h: a finished comparison as Python holds it.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>

#include "python/src/states/inputs.h"
#include "study/pair_study.h"

namespace espdiff::python {

struct Comparison : PairAnswer {
  StatePtr source, target;
};

/// Adds the class Comparison and the function compare().
void add_comparison(nanobind::module_& module);

}  // namespace espdiff::python
