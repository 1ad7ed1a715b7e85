// test_within_runs.cpp: exchange of blocks of frames between runs, for groups of one replicate.
#include "statistics/test_within_runs.h"

#include <algorithm>
#include <cmath>

#include "base/formatted.h"
#include "base/not_a_number.h"
#include "base/progress.h"
#include "statistics/columns.h"
#include "statistics/null_maxima.h"
#include "statistics/replicate_columns.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/surface_test.h"
#include "statistics/test_replicates.h"

namespace espdiff {
namespace {

/// Blocks of the shortest run at least, for 4 against 4 reach 0.029, and at most, for 7 against 7 have 3,432
/// permutations, which are all gone through. Longer runs get longer blocks instead of more: the longer, the less
/// does it matter whether the inefficiency was estimated right.
constexpr std::size_t kLeastBlocks = 4, kMostBlocks = 7;
/// Of a run that is longer than the shortest one, whose blocks are as long as there.
constexpr std::size_t kMostBlocksOfLonger = 70;

/// Blocks of one length for all runs, so that they can be exchanged.
RunBlocks choose_blocks(const std::vector<ReplicateColumns>& replicates, double inefficiency) {
  RunBlocks blocks;
  blocks.inefficiency = inefficiency;
  blocks.gap = static_cast<std::size_t>(std::ceil(blocks.inefficiency));
  const auto least_length = static_cast<std::size_t>(std::ceil(2 * blocks.inefficiency));
  blocks.least_frames = kLeastBlocks * (least_length + blocks.gap) - blocks.gap;
  std::size_t shortest = replicates.front().n_frames;
  for (const ReplicateColumns& r : replicates) shortest = std::min(shortest, r.n_frames);
  const std::size_t n = std::min(kMostBlocks, (shortest + blocks.gap) / (least_length + blocks.gap));
  blocks.length = n == 0 ? least_length : (shortest + blocks.gap) / n - blocks.gap;
  for (const ReplicateColumns& r : replicates)
    blocks.n.push_back(r.n_frames == shortest
                           ? n
                           : std::min(kMostBlocksOfLonger, (r.n_frames + blocks.gap) / (blocks.length + blocks.gap)));
  return blocks;
}

/// Adds the means of a replicate's blocks, [block][column], which are spread evenly over the run; NaN where a block
/// has no value, and where nothing is tested.
void add_block_means(const Columns& columns, std::size_t replicate, const RunBlocks& blocks,
                     const std::vector<char>& tested, std::vector<std::vector<double>>& means) {
  const std::size_t n = columns.n_frames(replicate), n_columns = columns.n_columns(), n_blocks = blocks.n[replicate];
  const std::size_t first = means.size();
  means.resize(first + n_blocks, std::vector<double>(n_columns, kNaN));
  const std::size_t at_once = std::max<std::size_t>(1, kColumnBytes / sizeof(float) / n);
  std::vector<float> values;
  for (std::size_t begin = 0; begin < n_columns; begin += at_once) {
    CancelRequest().check();
    const std::size_t end = std::min(n_columns, begin + at_once), width = end - begin;
    columns.read(replicate, begin, end, values);
#pragma omp parallel for schedule(dynamic, 16)
    for (std::size_t c = begin; c < end; ++c) {
      for (std::size_t b = 0; b < n_blocks && tested[c] != 0; ++b) {
        const std::size_t start = b * (n - blocks.length) / (n_blocks - 1);
        double sum = 0, count = 0;
        for (std::size_t f = start; f < start + blocks.length; ++f) {
          const auto value = static_cast<double>(values[f * width + c - begin]);
          if (!std::isfinite(value)) continue;
          sum += value;
          ++count;
        }
        means[first + b][c] = sum / count;
      }
    }
  }
}

/// Differences of the groups' means over all frames, each replicate with the same share; NaN where not tested.
std::vector<double> differences_of(const std::vector<ReplicateColumns>& replicates, std::size_t n_first,
                                   const std::vector<char>& tested) {
  std::vector<double> difference(tested.size(), 0);
  for (std::size_t v = 0; v < tested.size(); ++v) {
    for (std::size_t r = 0; r < replicates.size(); ++r) {
      const double share =
          r < n_first ? -1.0 / static_cast<double>(n_first) : 1.0 / static_cast<double>(replicates.size() - n_first);
      difference[v] += share * replicates[r].columns[v].mean;
    }
    if (tested[v] == 0) difference[v] = kNaN;
  }
  return difference;
}

/// What can be told without blocks: the difference.
SurfaceTest without_p(std::size_t n, const RunBlocks& blocks) {
  SurfaceTest test;
  const std::vector<double> none(n, kNaN);
  test.vertices = {none, none, none, none, none, none, none};
  test.p_max_t = test.p_tfce = none;
  test.tfce.assign(n, 0);
  test.n_permutations = 0;
  test.mean_abs_difference_p = test.mean_abs_difference_exchanged = kNaN;
  const std::size_t fewest = *std::min_element(blocks.n.begin(), blocks.n.end());
  test.no_p = formatted(
      "%.1f frames hold as much information as one (ninth decile over the surface), so that a run has %zu block%s that "
      "can be exchanged; %zu are needed, which takes %zu frames of each run, or two replicates and more of each state",
      blocks.inefficiency, fewest, fewest == 1 ? "" : "s", kLeastBlocks, blocks.least_frames);
  return test;
}

}  // namespace

double inefficiency_of_runs(const std::vector<ReplicateColumns>& replicates, const std::vector<char>& tested) {
  double largest = 1;
  for (const ReplicateColumns& replicate : replicates) {
    std::vector<double> g;
    for (std::size_t v = 0; v < tested.size(); ++v) {
      if (tested[v] != 0 && std::isfinite(replicate.columns[v].inefficiency))
        g.push_back(replicate.columns[v].inefficiency);
    }
    if (g.empty()) continue;
    const auto decile = g.begin() + static_cast<std::ptrdiff_t>(g.size() * 9 / 10);
    std::nth_element(g.begin(), decile, g.end());
    largest = std::max(largest, *decile);
  }
  return largest;
}

SurfaceTest test_within_runs(const Columns& columns, const std::vector<ReplicateColumns>& replicates,
                             std::size_t n_first, const std::vector<char>& tested, const MeshGraph& graph,
                             const SurfaceTestOptions& options) {
  const RunBlocks blocks =
      choose_blocks(replicates, std::max(options.least_inefficiency, inefficiency_of_runs(replicates, tested)));
  const bool enough = *std::min_element(blocks.n.begin(), blocks.n.end()) >= kLeastBlocks;
  std::vector<std::vector<double>> means;
  std::size_t n_first_blocks = 0;
  for (std::size_t r = 0; r < replicates.size() && enough; ++r) {
    if (r == n_first) n_first_blocks = means.size();
    add_block_means(columns, r, blocks, tested, means);
  }
  SurfaceTest test =
      enough ? test_replicates(means, n_first_blocks, graph, options) : without_p(graph.n_vertices(), blocks);
  test.inference = Inference::kWithinRuns;
  test.blocks = blocks;
  test.block_means = std::move(means);
  test.n_first_blocks = n_first_blocks;
  const std::vector<double> difference = differences_of(replicates, n_first, tested);
  for (std::size_t v = 0; v < difference.size(); ++v) move_to(test.vertices, v, difference[v]);
  test.mean_abs_difference = mean_abs(difference, graph);
  return test;
}

}  // namespace espdiff
