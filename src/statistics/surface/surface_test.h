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

/// Blocks of frames that are exchanged between runs.
struct RunBlocks {
  double inefficiency = 1;          ///< ninth decile over the vertices, of the run where it is largest
  std::size_t length = 0, gap = 0;  ///< frames of a block, and frames between blocks that are left out
  std::size_t least_frames = 0;     ///< that each run needs
  std::vector<std::size_t> n;       ///< [replicate]
};

/// A comparison of two groups at some places: vertices, residues or patches. [place], second - first group.
struct PlaceTests {
  std::vector<double> difference, error, degrees, t, p, low, high;  ///< p: of each place alone; low to high: interval
};

/// [permutation] the largest magnitudes on the surface, the observed labels first.
struct NullMaxima {
  std::vector<double> t, tfce;
};

/// A comparison over the surface.
struct SurfaceTest {
  Inference inference = Inference::kReplicates;
  PlaceTests vertices;
  std::vector<double> tfce;  ///< scores
  NullMaxima maxima;
  std::vector<double> p_max_t, p_tfce;  ///< family-wise over the surface; NaN where not tested
  std::size_t n_permutations = 0;
  bool exact = true;                         ///< all permutations
  double smallest_p = 1;                     ///< that these permutations allow
  double mean_abs_difference = 0;            ///< area-weighted
  double mean_abs_difference_p = 1;          ///< share of permutations with at least this
  double mean_abs_difference_exchanged = 0;  ///< its median over permutations with exchanged labels
  /// Within runs only: why there is no p and no interval; empty where there is one. The other members, except
  /// differences, are NaN then, or 0.
  std::string no_p;
  RunBlocks blocks;
  std::vector<std::vector<double>> block_means;  ///< [block][vertex], those of the first group first
  std::size_t n_first_blocks = 0;
};

struct SurfaceTestOptions {
  double confidence = 0.95;
  std::uint64_t max_permutations = 10000;
  std::uint64_t seed = 20221;
  /// Of blocks within runs, which are made for this statistical inefficiency at least.
  double least_inefficiency = 1;
};

/// Exchanges the labels of replicates. Statistic: Welch's t of the replicates' means. Its p-values are the shares of
/// permutations whose largest |t| (max-t) or TFCE score on the surface is at least the vertex' own: both control the
/// family-wise error (Nichols & Holmes 2002, Hum. Brain Mapp. 15:1; Winkler et al. 2014, NeuroImage 92:381). `p` and
/// the interval are Welch's, of each vertex alone.
/// @param means   [replicate][vertex], those of the first group first; NaN: not tested
/// @param n_first replicates of the first group; at least 2, as of the second
SurfaceTest test_replicates(const std::vector<std::vector<double>>& means, std::size_t n_first, const MeshGraph& graph,
                            const SurfaceTestOptions& options);

/// For a group of one replicate: cuts the runs into blocks, and does with their means what test_replicates() does with
/// those of replicates: Welch's t has its error estimated anew in each permutation. That is exact where blocks can be
/// exchanged. So they are at least twice as long as the statistical inefficiency g, and g frames between them are left
/// out: means of neighbouring blocks of an autoregressive series then have a correlation of 0.02, and 0.17 without the
/// gap. Differences are of all frames; errors, t and p of the blocks. With fewer than four blocks of a run there is no
/// p and no interval (`no_p`).
/// @param tested [vertex] nonzero where values are compared
SurfaceTest test_within_runs(const Columns& columns, const std::vector<ReplicateColumns>& replicates,
                             std::size_t n_first, const std::vector<char>& tested, const MeshGraph& graph,
                             const SurfaceTestOptions& options);

/// The statistical inefficiency that blocks within runs are made for: the ninth decile over the tested vertices, of the
/// run where it is largest; 1 without a value.
double inefficiency_of_runs(const std::vector<ReplicateColumns>& replicates, const std::vector<char>& tested);

/// Family-wise p over the surfaces of several tests together: the share of permutations whose largest |t|, or TFCE
/// score, on any of the surfaces is at least the vertex' own (the maximum over modalities, Winkler et al. 2016, Hum.
/// Brain Mapp. 37:1486). The tests exchange the same labels of the same replicates or blocks; those without p are left
/// alone.
void control_together(const std::vector<SurfaceTest*>& tests);

/// Compares area-weighted means over sets of vertices, such as residues or patches, by Welch's test of replicates, or
/// of the blocks of runs.
/// @param means [replicate][vertex], as in test_replicates()
/// @param members [place] vertices; those not tested do not count; a place without one has NaN
PlaceTests test_places(const SurfaceTest& surface, const std::vector<std::vector<double>>& means, std::size_t n_first,
                       const MeshGraph& graph, const std::vector<std::vector<std::uint32_t>>& members,
                       double confidence);

}  // namespace espdiff
