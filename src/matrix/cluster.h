// cluster.h: hierarchical clustering of variants by their distances.
#pragma once

#include <cstddef>
#include <vector>

namespace espdiff {

/// Two merged clusters. Variants are the clusters 0 to n - 1; the k-th merge makes cluster n + k.
struct ClusterMerge {
  std::size_t left = 0, right = 0;  ///< left contains the variant of smallest number
  double distance = 0;
  std::size_t n_variants = 0;  ///< in the new cluster
};

/// A symmetric table of distances between n items, [i * n + j]; NaN if unknown.
using DistanceTable = std::vector<double>;

/// Average linkage (UPGMA; Sokal and Michener, Univ. Kansas Sci. Bull. 38, 1409 (1958)): repeatedly merges the two
/// clusters with the smallest mean distance of their variants, over the known distances. Without known distances the
/// distance is NaN, and the merge comes last. Ties go to the smallest numbers (of left, then right). Time O(n^3), in
/// double precision, deterministic.
std::vector<ClusterMerge> average_linkage(const DistanceTable& distances, std::size_t n);

/// The variants from left to right under the tree of merges.
std::vector<std::size_t> dendrogram_order(const std::vector<ClusterMerge>& merges, std::size_t n);

/// Pearson's correlation of two series over the places where both are finite; NaN with fewer than 3, or if one is
/// constant.
double correlation(const std::vector<double>& a, const std::vector<double>& b);
/// Spearman's correlation; equal values share the mean of their ranks.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace espdiff
