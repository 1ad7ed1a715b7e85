// read_matrix.h: reads a matrix's OUT.json, for drawing.
#pragma once

#include <string>
#include <vector>

#include "matrix/cluster.h"

namespace espdiff {

/// One metric of OUT.json.
struct MatrixFileMetric {
  std::string name, title, unit;
  std::vector<double> values;  ///< [source * n + target]; NaN on the diagonal and for missing values
};

struct MatrixFile {
  std::vector<std::string> labels, groups;  ///< [variant]
  std::vector<MatrixFileMetric> metrics;
  std::vector<bool> trustworthy;  ///< [source * n + target]
  std::string clustered_by;       ///< a metric
  std::vector<ClusterMerge> merges;

  std::size_t n() const { return labels.size(); }
  /// @throws InputError listing the metrics
  const MatrixFileMetric& metric(const std::string& name) const;
  /// The position of a label. @throws InputError
  std::size_t find(const std::string& label) const;
};

/// @throws IoError, FormatError (not the JSON of a matrix)
MatrixFile read_matrix_json(const std::string& path);

}  // namespace espdiff
