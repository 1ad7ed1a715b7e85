// template_matrix.h: a matrix through a template, where the build has HDF5, which keeps its potentials.
#pragma once

#include <string>
#include <vector>

#include "handles.h"

namespace espdiff {
struct Variant;
}

namespace espdiff::vmdplugin {

/// Runs it. @throws as run_template_matrix(); InputError without HDF5
MatrixReport matrix_by_template(const MatrixObject& object, Engine& engine, const std::vector<Variant>& variants,
                                const Progress& progress);

/// Merges parts of a matrix of either kind. @throws as merge_matrix() and merge_template_matrix()
MatrixReport merged_matrix(const std::vector<std::string>& paths, const MatrixRun& run);

}  // namespace espdiff::vmdplugin
