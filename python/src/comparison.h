// comparison.h: a finished comparison as Python holds it.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>

#include "compare/result.h"
#include "inputs.h"
#include "report/write_compare.h"

namespace espdiff::python {

struct Comparison {
  StatePtr source, target;
  Molecule source_molecule, target_molecule;  ///< as they were compared
  std::vector<KeptFile> kept;                 ///< of the states that no file holds as they were compared
  CompareOptions options;
  Provenance provenance;
  CompareResult result;
};

/// Adds the class Comparison and the function compare().
void add_comparison(nanobind::module_& module);

}  // namespace espdiff::python
