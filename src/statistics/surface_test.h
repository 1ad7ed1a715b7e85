// surface_test.h: two groups of replicates compared at each vertex, with control of the errors over the surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace espdiff {

class Columns;
struct MeshGraph;
struct ReplicateColumns;

/// What the p-values are a statement about.
enum class Inference {
  kReplicates,  ///< the states: replicates are the samples
  kWithinRuns   ///< these runs only: blocks of frames are the samples, since a group has one replicate
};

/// A comparison of two groups at some places: vertices, residues or patches. [place], second - first group.
struct PlaceTests {
  std::vector<double> difference, error, degrees, t, p, low, high;  ///< p: of each place alone; low to high: interval
};

/// A comparison over the surface.
struct SurfaceTest {
  Inference inference = Inference::kReplicates;
  PlaceTests vertices;
  std::vector<double> tfce;                  ///< scores
  std::vector<double> p_max_t, p_tfce;       ///< family-wise over the surface; NaN where not tested
  std::size_t n_arrangements = 0;            ///< or bootstrap samples
  bool exact = true;                         ///< all arrangements
  double smallest_p = 1;                     ///< that these arrangements allow
  double mean_abs_difference = 0;            ///< area-weighted
  double mean_abs_difference_p = 1;          ///< share of arrangements with at least this
  double mean_abs_difference_exchanged = 0;  ///< its median over arrangements with exchanged labels
  std::vector<std::size_t> block_lengths;    ///< [replicate] of the bootstrap
  /// [sample][vertex] bootstrap's deviations from the observed difference; residues and patches need them
  std::vector<float> deviations;
};

struct SurfaceTestOptions {
  double confidence = 0.95;
  std::uint64_t most_arrangements = 10000;
  std::uint64_t seed = 20221;
  std::size_t n_bootstrap = 999;
};

/// Exchanges the labels of replicates. Statistic: Welch's t of the replicates' means. Its p-values are the shares of
/// arrangements whose largest |t| (max-t) or TFCE score on the surface is at least the vertex' own: both control the
/// family-wise error (Nichols & Holmes 2002, Hum. Brain Mapp. 15:1; Winkler et al. 2014, NeuroImage 92:381). `p` and
/// the interval are Welch's, of each vertex alone.
/// @param means   [replicate][vertex], those of the first group first; NaN: not tested
/// @param n_first replicates of the first group; at least 2, as of the second
SurfaceTest test_replicates(const std::vector<std::vector<double>>& means, std::size_t n_first, const MeshGraph& graph,
                            const SurfaceTestOptions& options);

/// For a group of one replicate: resamples each run by circular blocks (Politis & Romano 1992) of twice its statistical
/// inefficiency (the ninth decile of its vertices'), at least the cubic root of its length. t is the difference over
/// its bootstrap error; the deviations of the samples, in that error, are the null for p, max-t and TFCE.
/// @param tested [vertex] nonzero where values are compared
SurfaceTest test_within_runs(const Columns& columns, const std::vector<ReplicateColumns>& replicates,
                             std::size_t n_first, const std::vector<char>& tested, const MeshGraph& graph,
                             const SurfaceTestOptions& options);

/// Compares area-weighted means over sets of vertices, such as residues or patches: Welch's test of replicates, or the
/// bootstrap's samples.
/// @param members [place] vertices; those not tested do not count; a place without one has NaN
PlaceTests test_places(const SurfaceTest& surface, const std::vector<std::vector<double>>& means, std::size_t n_first,
                       const MeshGraph& graph, const std::vector<std::vector<std::uint32_t>>& members,
                       double confidence);

}  // namespace espdiff
