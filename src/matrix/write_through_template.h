// write_through_template.h: what OUT.json and the printed table say of the template of a matrix.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>

#include "matrix/matrix_summary.h"

namespace espdiff {

/// Keys: name, sha256, n_vertices, area_A2, options (of the mappings), compared_area_fraction (mean and least over the
/// pairs, of the template's area), states (label, RMSD and checks of its mapping; null with the error of a state that
/// could not be mapped), absent (metrics that a template does not give), not_checked (names as in a comparison), exact:
/// pairs (source, target, trustworthy, error, and the metrics by themselves) and agreement by metric (null for
/// correlations of fewer than three pairs).
/// @pre the matrix is through a template
nlohmann::ordered_json through_template_json(const Matrix& matrix);

/// Prints how the exact pairs agree, which states are not trustworthy, and what a template does not give.
/// @pre the matrix is through a template
void print_through_template(std::ostream& out, const Matrix& matrix);

}  // namespace espdiff
