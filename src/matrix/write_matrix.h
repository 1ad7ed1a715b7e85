// write_matrix.h: writes a matrix as files.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "matrix/matrix_summary.h"

namespace espdiff {

/// Writes OUT.csv and OUT.json; both appear, or neither, and older ones stay. The bytes depend on the matrix only, not
/// on times, threads, interruptions, or the number of processes.
///
/// OUT.csv: a row for each ordered pair: source, target, their groups, the unit of potentials, every metric
/// (Matrix::metrics(); empty for missing values), converged, trustworthy and, of a region and of patches,
/// PART_trustworthy (1 or 0), reasons, warnings, error.
/// OUT.json: matrix_json().
/// @param metric the metric for clustering
/// @returns the files' names
/// @throws IoError
std::vector<std::string> write_matrix(const std::string& output_prefix, const Matrix& matrix, std::size_t metric);

/// Keys: version, device, potential, potential_unit, options (options_json()), variants (label, group, inputs); fields
/// (what each is; absent without); of a matrix through a template `template` (through_template_json()), and only the
/// metrics that it gives; metrics, by name: title, unit, values [source][target], null on the diagonal and for missing
/// values; trustworthy, PART_trustworthy (of a region and of patches), converged [source][target]; not_trustworthy
/// (source, target, reasons), errors; asymmetry by metric; groups by metric (absent without groups); clustering
/// (metric, linkage, merges [left, right, distance, number of variants], order); hodgkin: the clustering by Hodgkin's
/// index and the correlation of its distances with those of `metric` (null without potentials).
nlohmann::ordered_json matrix_json(const Matrix& matrix, std::size_t metric);

}  // namespace espdiff
