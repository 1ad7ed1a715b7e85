// cluster.h: hierarchical clustering of variants by their distances.
#pragma once

#include <cstddef>
#include <vector>

namespace espdiff {

/// Two clusters that became one. Variants are the clusters 0 to n - 1; the k-th merge makes cluster n + k.
struct ClusterMerge {
  std::size_t left = 0, right = 0;  ///< left holds the variant of the smallest number
  double distance = 0;
  std::size_t n_variants = 0;  ///< in the new cluster
};

/// A symmetric table of distances between n things, [i * n + j]; NaN where one is not known.
using DistanceTable = std::vector<double>;

/// Average linkage (UPGMA; Sokal and Michener, Univ. Kansas Sci. Bull. 38, 1409 (1958)): the two clusters merge whose
/// variants are nearest to each other on average, over the distances that are known; where none is, the distance is NaN
/// and the merge comes last. Of equal distances the pair with the smallest numbers (of left, then right) merges first.
/// Time O(n^3), in double precision; the same result always.
std::vector<ClusterMerge> average_linkage(const DistanceTable& distances, std::size_t n);

/// The variants from left to right under the tree of merges.
std::vector<std::size_t> dendrogram_order(const std::vector<ClusterMerge>& merges, std::size_t n);

/// Pearson's correlation of two series, over the places where both are finite; NaN with fewer than 3, or when one is
/// constant.
double correlation(const std::vector<double>& a, const std::vector<double>& b);
/// Spearman's: that of the ranks; equal values share the mean of their ranks.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace espdiff
