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

}  // namespace espdiff
