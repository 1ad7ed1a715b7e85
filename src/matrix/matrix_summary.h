// matrix_summary.h: a matrix as a whole: how far both directions differ, groups, clusters, and the Hodgkin index beside
// it.
#pragma once

#include <string>
#include <vector>

#include "matrix/cluster.h"
#include "matrix/matrix_plan.h"

namespace espdiff {

/// A complete matrix.
struct Matrix {
  MatrixPlan plan;
  std::vector<MatrixCell> cells;  ///< source by source, without the diagonal: matrix_pairs() of all variants

  std::size_t n() const { return plan.variants.size(); }
  /// @param source, target different
  const MatrixCell& cell(std::size_t source, std::size_t target) const {
    return cells[source * (n() - 1) + (target < source ? target : target - 1)];
  }
  double value(std::size_t metric, std::size_t source, std::size_t target) const {
    return cell(source, target).values[metric];
  }
};

/// Puts cells into order. A pair may be there twice if both say the same.
/// @param hint what to do about missing pairs, for the message
/// @throws InputError (pairs missing: how many and which first; two cells of a pair that differ)
Matrix assemble(const MatrixPlan& plan, const std::vector<MatrixCell>& cells, const std::string& hint);

/// The mean of both directions' values, or their one value where the other is missing, as a distance: of an
/// antisymmetric metric the mean magnitude, of a similarity index s sqrt(2 - 2 s), which is 0 for equal potentials
/// (for Hodgkin's index: Blomberg et al., Proteins 37, 379 (1999)).
DistanceTable symmetric_distances(const Matrix& matrix, std::size_t metric);

/// How far the directions of the pairs differ: |a - b|, of an antisymmetric metric |a + b|, in units of the mean
/// magnitude over the matrix.
struct Asymmetry {
  double mean = 0, max = 0;           ///< NaN without pairs
  std::size_t first = 0, second = 0;  ///< the pair of the largest
};
Asymmetry asymmetry(const Matrix& matrix, std::size_t metric);

/// The cells from one group to another, the own one included.
struct GroupMean {
  std::string source, target;
  std::size_t n = 0;  ///< cells with a value
  std::size_t n_trustworthy = 0;
  double mean = 0, min = 0, max = 0;
};
/// Groups in the order of their first variants; nothing where no variant has a group.
std::vector<GroupMean> group_means(const Matrix& matrix, std::size_t metric);

struct Clustering {
  std::size_t metric = 0;
  std::vector<ClusterMerge> merges;
  std::vector<std::size_t> order;
};
Clustering cluster(const Matrix& matrix, std::size_t metric);
/// mean_abs_difference where there are potentials, else mean_displacement_A.
std::size_t usual_metric(const Matrix& matrix);

}  // namespace espdiff
