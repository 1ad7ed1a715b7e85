// ensemble_result.h: what an ensemble says, as Python holds it.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ensemble/ensemble_study.h"

namespace espdiff::python {

struct PyEnsemble {
  EnsembleAnswer answer;
  std::vector<std::string> warnings;                                          ///< about the design, before the run
  std::vector<std::pair<std::string, std::shared_ptr<PyEnsemble>>> fields{};  ///< by name
};

/// Adds the class Ensemble.
void add_ensemble_result(nanobind::module_& module);

}  // namespace espdiff::python
