// ensemble_settings.h: the options of an ensemble besides those of a comparison, once for the command line, Tcl and
// Python.
#pragma once

#include <vector>

#include "ensemble/ensemble_study.h"
#include "options/option_row.h"

namespace espdiff {

/// In the order of the manuals.
const std::vector<OptionRow<EnsembleStudy>>& ensemble_settings();

}  // namespace espdiff
