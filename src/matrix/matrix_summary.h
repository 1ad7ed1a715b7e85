// matrix_summary.h: summary of a matrix: asymmetry, groups, clusters, and comparison with the Hodgkin index.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "matrix/cluster.h"
#include "matrix/matrix_plan.h"
#include "matrix/through_template.h"

namespace espdiff {

/// A complete matrix.
struct Matrix {
  MatrixPlan plan;
  std::vector<MatrixCell> cells;             ///< source by source, without the diagonal: matrix_pairs() of all variants
  std::optional<ThroughTemplate> through{};  ///< absent where each pair was compared by itself

  std::size_t n() const { return plan.variants.size(); }
  const std::vector<Metric>& metrics() const { return matrix_metrics(plan.compared()); }
  /// Whether its cells have the metric at all; without potentials some have no value nevertheless.
  bool gives(std::size_t metric) const { return !through || is_given_by_template(metrics()[metric]); }
  /// @param source, target different
  const MatrixCell& cell(std::size_t source, std::size_t target) const {
    return cells[source * (n() - 1) + (target < source ? target : target - 1)];
  }
  double value(std::size_t metric, std::size_t source, std::size_t target) const {
    return cell(source, target).values[metric];
  }
};

/// Puts cells in order. A pair may occur twice with equal values.
/// @param from the file or files that have the cells, for the message
/// @param hint the remedy for missing pairs, for the message
/// @throws InputError (missing pairs: how many, and the first; a pair with two different cells)
Matrix assemble(const MatrixPlan& plan, const std::vector<MatrixCell>& cells, const std::string& from,
                const std::string& hint);

/// The mean of both directions' values as a distance, or the only value. For an antisymmetric metric the mean
/// magnitude; for a similarity index s sqrt(2 - 2 s), which is 0 for equal potentials (for Hodgkin's index: Blomberg et
/// al., Proteins 37, 379 (1999)).
DistanceTable symmetric_distances(const Matrix& matrix, std::size_t metric);

/// Difference of the two directions: |a - b|, for an antisymmetric metric |a + b|, in units of the mean magnitude over
/// the matrix.
struct Asymmetry {
  double mean = 0, max = 0;           ///< NaN without pairs
  std::size_t first = 0, second = 0;  ///< the pair with the largest difference
};
Asymmetry asymmetry(const Matrix& matrix, std::size_t metric);

/// The cells from one group to another, or within one.
struct GroupMean {
  std::string source, target;
  std::size_t n = 0;  ///< cells with a value
  std::size_t n_trustworthy = 0;
  double mean = 0, min = 0, max = 0;
};
/// Groups in the order of their first variants; empty if no variant has a group.
std::vector<GroupMean> group_means(const Matrix& matrix, std::size_t metric);

struct Clustering {
  std::size_t metric = 0;
  std::vector<ClusterMerge> merges;
  std::vector<std::size_t> order;
};
Clustering cluster(const Matrix& matrix, std::size_t metric);
/// mean_abs_difference if there are potentials, otherwise mean_displacement_A.
std::size_t usual_metric(const Matrix& matrix);

}  // namespace espdiff
