// test_replicates.cpp: Welch's t at each vertex, and the exchange of labels over the surface.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/progress.h"
#include "statistics/permutations.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/null_maxima.h"
#include "statistics/surface/surface_test.h"
#include "statistics/surface/tfce.h"
#include "statistics/welch.h"

namespace espdiff {
namespace {

using Means = std::vector<std::vector<double>>;

/// Both groups' moments at a vertex under an permutation.
struct Split {
  GroupMoments first, second;
};

Split split_at(const Means& means, std::size_t vertex, const std::vector<std::uint32_t>& order, std::size_t n_first,
               std::vector<double>& scratch) {
  scratch.clear();
  for (const std::uint32_t r : order) scratch.push_back(means[r][vertex]);
  return {group_moments(scratch.data(), n_first), group_moments(scratch.data() + n_first, order.size() - n_first)};
}

struct Maps {
  std::vector<double> t, difference;
};

Maps maps_of(const Means& means, const std::vector<std::uint32_t>& order, std::size_t n_first) {
  const std::size_t n = means.front().size();
  Maps maps{std::vector<double>(n), std::vector<double>(n)};
  std::vector<double> scratch;
  for (std::size_t v = 0; v < n; ++v) {
    const Split split = split_at(means, v, order, n_first, scratch);
    maps.t[v] = welch_t(split.first, split.second);
    maps.difference[v] = split.second.mean - split.first.mean;
  }
  return maps;
}

}  // namespace

double mean_abs(const std::vector<double>& values, const MeshGraph& graph) {
  double sum = 0, area = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!std::isfinite(values[v])) continue;
    sum += graph.area[v] * std::fabs(values[v]);
    area += graph.area[v];
  }
  return sum / area;
}

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::fabs(value));
  }
  return largest;
}

/// Equal values of different order of summation count as equal.
double share_at_least(const std::vector<double>& sorted, double value) {
  const double limit = std::fabs(value) * (1 - 1e-9);
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), limit);
  return static_cast<double>(sorted.end() - first) / static_cast<double>(sorted.size());
}

std::vector<double> shares_at_least(std::vector<double> maxima, const std::vector<double>& values,
                                    const std::vector<double>& tested) {
  std::sort(maxima.begin(), maxima.end());
  std::vector<double> p(values.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (std::isfinite(tested[v])) p[v] = share_at_least(maxima, values[v]);
  }
  return p;
}

void add_place(PlaceTests& tests, const WelchTest& test, double confidence) {
  const double half = student_quantile(confidence, test.degrees) * test.error;
  tests.difference.push_back(test.difference);
  tests.error.push_back(test.error);
  tests.degrees.push_back(test.degrees);
  tests.t.push_back(test.t);
  tests.p.push_back(test.p);
  tests.low.push_back(test.difference - half);
  tests.high.push_back(test.difference + half);
}

void move_to(PlaceTests& tests, std::size_t place, double difference) {
  const double by = difference - tests.difference[place];
  tests.difference[place] = difference;
  tests.low[place] += by;
  tests.high[place] += by;
}

SurfaceTest test_replicates(const Means& means, std::size_t n_first, const MeshGraph& graph,
                            const SurfaceTestOptions& options) {
  SurfaceTest test;
  const Permutations all = make_permutations(n_first, means.size() - n_first, options.max_permutations, options.seed);
  test.n_permutations = all.orders.size();
  test.exact = all.exact;
  test.smallest_p = all.smallest_p();
  std::vector<double> scratch;
  for (std::size_t v = 0; v < graph.n_vertices(); ++v) {
    const Split split = split_at(means, v, all.orders.front(), n_first, scratch);
    add_place(test.vertices, welch_test(split.first, split.second), options.confidence);
  }
  test.tfce = enhance_clusters(test.vertices.t, graph);
  test.maxima = {std::vector<double>(all.orders.size()), std::vector<double>(all.orders.size())};
  std::vector<double> differences(all.orders.size());
  const CancelRequest cancel;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t k = 0; k < all.orders.size(); ++k) {
    if (cancel.made()) continue;
    const Maps maps = maps_of(means, all.orders[k], n_first);
    test.maxima.t[k] = largest_magnitude(maps.t);
    test.maxima.tfce[k] = largest_magnitude(enhance_clusters(maps.t, graph));
    differences[k] = mean_abs(maps.difference, graph);
  }
  cancel.check();
  test.p_max_t = shares_at_least(test.maxima.t, test.vertices.t, test.vertices.t);
  test.p_tfce = shares_at_least(test.maxima.tfce, test.tfce, test.vertices.t);
  test.mean_abs_difference = differences.front();
  std::sort(differences.begin(), differences.end());
  test.mean_abs_difference_p = share_at_least(differences, test.mean_abs_difference);
  test.mean_abs_difference_exchanged = differences[differences.size() / 2];
  return test;
}

}  // namespace espdiff
