// matrix_summary.cpp: assembles and summarizes a matrix.
#include "matrix/matrix_summary.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/not_a_number.h"

namespace espdiff {
namespace {

bool same_value(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool same_cell(const MatrixCell& a, const MatrixCell& b) {
  return std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(), same_value) &&
         a.converged == b.converged && a.trustworthy == b.trustworthy && a.parts_trustworthy == b.parts_trustworthy &&
         a.reasons == b.reasons && a.warnings == b.warnings && a.error == b.error;
}

double mean_of_known(double a, double b) {
  if (std::isnan(a)) return b;
  return std::isnan(b) ? a : 0.5 * (a + b);
}

double as_distance(const Metric& metric, double a, double b) {
  if ((metric.flags & kAntisymmetric) != 0) return mean_of_known(std::fabs(a), std::fabs(b));
  const double mean = mean_of_known(a, b);
  return metric.unit == MetricUnit::kIndex ? std::sqrt(std::max(0.0, 2 - 2 * mean)) : mean;
}

}  // namespace

Matrix assemble(const MatrixPlan& plan, const std::vector<MatrixCell>& cells, const std::string& from,
                const std::string& hint) {
  Matrix matrix{plan, {}, {}};
  const std::size_t n = matrix.n();
  std::vector<const MatrixCell*> found(n * (n - 1), nullptr);
  const auto name = [&](const MatrixPair& pair) {
    return plan.variants[pair.first].label + " to " + plan.variants[pair.second].label;
  };
  for (const MatrixCell& cell : cells) {
    const MatrixCell*& place =
        found[cell.source * (n - 1) + (cell.target < cell.source ? cell.target : cell.target - 1)];
    if (place != nullptr && !same_cell(*place, cell))
      throw InputError(from + ": the pair " + name({cell.source, cell.target}) +
                       " is there twice, with different values; compute one part of the matrix anew");
    place = &cell;
  }
  const auto missing = static_cast<std::size_t>(std::count(found.begin(), found.end(), nullptr));
  if (missing > 0) {
    const auto first = static_cast<std::size_t>(std::find(found.begin(), found.end(), nullptr) - found.begin());
    throw InputError(from + ": " + std::to_string(missing) + " of " + std::to_string(found.size()) +
                     " pairs are missing, the first " + name(matrix_pairs(n)[first]) + "; " + hint);
  }
  for (const MatrixCell* cell : found) matrix.cells.push_back(*cell);
  return matrix;
}

DistanceTable symmetric_distances(const Matrix& matrix, std::size_t metric) {
  const std::size_t n = matrix.n();
  DistanceTable distances(n * n, 0.0);
  const Metric& of = matrix.metrics()[metric];
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      distances[i * n + j] = distances[j * n + i] =
          as_distance(of, matrix.value(metric, i, j), matrix.value(metric, j, i));
    }
  }
  return distances;
}

Asymmetry asymmetry(const Matrix& matrix, std::size_t metric) {
  const double sign = (matrix.metrics()[metric].flags & kAntisymmetric) != 0 ? -1 : 1;
  Asymmetry result;
  double sum = 0, magnitudes = 0;
  std::size_t n_pairs = 0;
  for (std::size_t i = 0; i < matrix.n(); ++i) {
    for (std::size_t j = i + 1; j < matrix.n(); ++j) {
      const double a = matrix.value(metric, i, j), b = sign * matrix.value(metric, j, i);
      const double difference = std::fabs(a - b);
      if (!std::isfinite(difference)) continue;
      if (n_pairs == 0 || difference > result.max) result = {0, difference, i, j};
      sum += difference;
      magnitudes += 0.5 * (std::fabs(a) + std::fabs(b));
      ++n_pairs;
    }
  }
  const double mean_magnitude = magnitudes / static_cast<double>(n_pairs);  // NaN without pairs
  const double scale = mean_magnitude > 0 ? 1 / mean_magnitude : (n_pairs > 0 ? 0 : kNaN);
  result.mean = scale * sum / static_cast<double>(std::max<std::size_t>(n_pairs, 1));
  result.max *= scale;
  return result;
}

std::vector<GroupMean> group_means(const Matrix& matrix, std::size_t metric) {
  std::vector<std::string> groups;
  for (const MatrixPlan::Item& item : matrix.plan.variants) {
    if (!item.group.empty() && std::find(groups.begin(), groups.end(), item.group) == groups.end())
      groups.push_back(item.group);
  }
  std::vector<GroupMean> means;
  for (const std::string& source : groups) {
    for (const std::string& target : groups) {
      GroupMean mean{source, target, 0, 0, 0, kNaN, kNaN};
      for (const MatrixCell& cell : matrix.cells) {
        const double value = cell.values[metric];
        if (matrix.plan.variants[cell.source].group != source || matrix.plan.variants[cell.target].group != target ||
            std::isnan(value))
          continue;
        mean.mean += value;
        if (!(value >= mean.min)) mean.min = value;
        if (!(value <= mean.max)) mean.max = value;
        mean.n_trustworthy += cell.trustworthy ? 1 : 0;
        ++mean.n;
      }
      mean.mean = mean.n > 0 ? mean.mean / static_cast<double>(mean.n) : kNaN;
      means.push_back(mean);
    }
  }
  return means;
}

Clustering cluster(const Matrix& matrix, std::size_t metric) {
  Clustering result;
  result.metric = metric;
  result.merges = average_linkage(symmetric_distances(matrix, metric), matrix.n());
  result.order = dendrogram_order(result.merges, matrix.n());
  return result;
}

std::size_t usual_metric(const Matrix& matrix) {
  return find_metric(matrix.plan.potential.empty() ? "mean_displacement_A" : "mean_abs_difference");
}

}  // namespace espdiff
