// test_replicates.cpp: Welch's t at each vertex, and the exchange of labels over the surface.
#include "statistics/test_replicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/progress.h"
#include "statistics/null_maxima.h"
#include "statistics/permutations.h"
#include "statistics/surface/mesh_graph.h"
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
