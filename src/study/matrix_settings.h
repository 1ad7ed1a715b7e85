// matrix_settings.h: the options of a matrix besides those of a comparison, once for the command line, Tcl and Python.
#pragma once

#include <vector>

#include "base/text/option_row.h"
#include "study/matrix_study.h"

namespace espdiff {

/// In the order of the manuals.
const std::vector<OptionRow<MatrixStudy>>& matrix_settings();
/// Those of them that the merging of its parts has, too.
const std::vector<OptionRow<MatrixStudy>>& merge_settings();

}  // namespace espdiff
