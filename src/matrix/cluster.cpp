// cluster.cpp: average linkage by sums of distances, and correlations.
#include "matrix/cluster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/not_a_number.h"

namespace espdiff {
namespace {

/// Sum and number of the known distances between two clusters' variants.
struct Link {
  double sum = 0;
  std::size_t n = 0;
  double mean() const { return n > 0 ? sum / static_cast<double>(n) : std::numeric_limits<double>::infinity(); }
};

struct Cluster {
  std::size_t id = 0;     ///< as in ClusterMerge
  std::size_t first = 0;  ///< its variant of smallest number
  std::size_t n_variants = 1;
  std::vector<Link> links;  ///< [place] to the cluster at that place
};

/// The nearest pair of places; clusters stay in the order of their first variants.
std::pair<std::size_t, std::size_t> nearest(const std::vector<Cluster>& clusters) {
  std::pair<std::size_t, std::size_t> best{0, 1};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < clusters.size(); ++a) {
    for (std::size_t b = a + 1; b < clusters.size(); ++b) {
      const double distance = clusters[a].links[b].mean();
      if (distance < least) {
        least = distance;
        best = {a, b};
      }
    }
  }
  return best;
}

/// Merges the cluster at place b into that at place a.
void join(std::vector<Cluster>& clusters, std::size_t a, std::size_t b, std::size_t id) {
  for (std::size_t other = 0; other < clusters.size(); ++other) {
    const Link& from = clusters[b].links[other];
    Link& to = clusters[a].links[other];
    to.sum += from.sum;
    to.n += from.n;
    clusters[other].links[a] = to;
  }
  clusters[a].id = id;
  clusters[a].n_variants += clusters[b].n_variants;
  clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(b));
  for (Cluster& cluster : clusters) cluster.links.erase(cluster.links.begin() + static_cast<std::ptrdiff_t>(b));
}

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> result(values.size());
  for (std::size_t start = 0; start < order.size();) {
    std::size_t end = start;
    while (end < order.size() && values[order[end]] == values[order[start]]) ++end;
    for (std::size_t i = start; i < end; ++i) result[order[i]] = 0.5 * static_cast<double>(start + end - 1);
    start = end;
  }
  return result;
}

/// Removes the places where either value is not finite.
void keep_known(std::vector<double>& a, std::vector<double>& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    a[n] = a[i];
    b[n] = b[i];
    ++n;
  }
  a.resize(n);
  b.resize(n);
}

}  // namespace

std::vector<ClusterMerge> average_linkage(const DistanceTable& distances, std::size_t n) {
  std::vector<Cluster> clusters(n);
  for (std::size_t i = 0; i < n; ++i) {
    clusters[i].id = clusters[i].first = i;
    clusters[i].links.resize(n);
    for (std::size_t j = 0; j < n; ++j) {
      const double d = distances[i * n + j];
      if (i != j && std::isfinite(d)) clusters[i].links[j] = {d, 1};
    }
  }
  std::vector<ClusterMerge> merges;
  while (clusters.size() > 1) {
    const auto [a, b] = nearest(clusters);
    const double distance = clusters[a].links[b].mean();
    merges.push_back({clusters[a].id, clusters[b].id, std::isfinite(distance) ? distance : kNaN,
                      clusters[a].n_variants + clusters[b].n_variants});
    join(clusters, a, b, n + merges.size() - 1);
  }
  return merges;
}

std::vector<std::size_t> dendrogram_order(const std::vector<ClusterMerge>& merges, std::size_t n) {
  std::vector<std::vector<std::size_t>> leaves(n);
  for (std::size_t i = 0; i < n; ++i) leaves[i] = {i};
  for (const ClusterMerge& merge : merges) {
    std::vector<std::size_t> joined = leaves[merge.left];
    joined.insert(joined.end(), leaves[merge.right].begin(), leaves[merge.right].end());
    leaves.push_back(std::move(joined));
  }
  return leaves.empty() ? std::vector<std::size_t>() : leaves.back();
}

double correlation(const std::vector<double>& a_given, const std::vector<double>& b_given) {
  std::vector<double> a = a_given, b = b_given;
  keep_known(a, b);
  const std::size_t n = a.size();
  if (n < 3) return kNaN;
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / static_cast<double>(n);
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / static_cast<double>(n);
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < n; ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : kNaN;
}

double rank_correlation(const std::vector<double>& a_given, const std::vector<double>& b_given) {
  std::vector<double> a = a_given, b = b_given;
  keep_known(a, b);
  return correlation(ranks(a), ranks(b));
}

}  // namespace espdiff
