// test_within_runs.cpp: circular block bootstrap of runs, for groups of one replicate.
#include <algorithm>
#include <cmath>

#include "base/not_a_number.h"
#include "base/progress.h"
#include "statistics/columns.h"
#include "statistics/counter_random.h"
#include "statistics/mesh_graph.h"
#include "statistics/null_maxima.h"
#include "statistics/replicate_columns.h"
#include "statistics/surface_test.h"
#include "statistics/tfce.h"

namespace espdiff {
namespace {

std::size_t block_length(const ReplicateColumns& replicate, const std::vector<char>& tested) {
  std::vector<double> g;
  for (std::size_t v = 0; v < tested.size(); ++v) {
    if (tested[v] != 0 && std::isfinite(replicate.columns[v].inefficiency))
      g.push_back(replicate.columns[v].inefficiency);
  }
  if (g.empty()) return 1;
  const auto decile = g.begin() + static_cast<std::ptrdiff_t>(g.size() * 9 / 10);
  std::nth_element(g.begin(), decile, g.end());
  const double n = static_cast<double>(replicate.n_frames);
  const double length = std::ceil(std::max(2 * *decile, std::cbrt(n)));
  return static_cast<std::size_t>(std::min(length, std::max(1.0, n / 2)));
}

/// Sums of a series up to each frame, twice around.
struct RunningSums {
  std::vector<double> sum;
  std::vector<std::uint32_t> count;

  void set(const std::vector<float>& values, std::size_t column, std::size_t width, std::size_t n) {
    sum.assign(2 * n + 1, 0);
    count.assign(2 * n + 1, 0);
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const double value = static_cast<double>(values[(i % n) * width + column]);
      sum[i + 1] = sum[i] + (std::isfinite(value) ? value : 0);
      count[i + 1] = count[i] + (std::isfinite(value) ? 1U : 0U);
    }
  }
};

/// The mean of one resample: blocks from random starts, the last one cut to the run's length.
double resampled_mean(const RunningSums& sums, std::size_t n, std::size_t length, std::uint64_t seed,
                      std::uint64_t stream) {
  double sum = 0;
  std::uint64_t count = 0;
  for (std::size_t done = 0, block = 0; done < n; done += length, ++block) {
    const std::size_t start = random_below(n, seed, stream, block), end = start + std::min(length, n - done);
    sum += sums.sum[end] - sums.sum[start];
    count += sums.count[end] - sums.count[start];
  }
  return count > 0 ? sum / static_cast<double>(count) : kNaN;
}

/// Adds a replicate's resampled means, with its share in the difference, to the samples.
void add_samples(const Columns& columns, std::size_t replicate, std::size_t length, double share, std::size_t n_samples,
                 std::uint64_t seed, const std::vector<char>& tested, std::vector<float>& samples) {
  const std::size_t n = columns.n_frames(replicate), n_columns = columns.n_columns();
  const std::size_t at_once = std::max<std::size_t>(1, kColumnBytes / sizeof(float) / n);
  std::vector<float> values;
  const CancelRequest cancel;
  for (std::size_t begin = 0; begin < n_columns; begin += at_once) {
    cancel.check();
    const std::size_t end = std::min(n_columns, begin + at_once);
    columns.read(replicate, begin, end, values);
#pragma omp parallel for schedule(dynamic, 16)
    for (std::size_t c = begin; c < end; ++c) {
      if (tested[c] == 0 || cancel.made()) continue;
      RunningSums sums;
      sums.set(values, c - begin, end - begin, n);
      for (std::size_t b = 0; b < n_samples; ++b)
        samples[b * n_columns + c] += static_cast<float>(share * resampled_mean(sums, n, length, seed + replicate, b));
    }
  }
}

/// Sets one place from its difference and the samples' deviations from it.
void add_bootstrapped(PlaceTests& tests, double difference, std::vector<double>& deviations, double confidence) {
  double squares = 0;
  for (const double d : deviations) squares += d * d;
  const double n = static_cast<double>(deviations.size());
  const double error = squares > 0 ? std::sqrt(squares / n) : kNaN;
  for (double& d : deviations) d = std::fabs(d);
  std::sort(deviations.begin(), deviations.end());
  const auto place = static_cast<std::size_t>(std::ceil(confidence * n)) - 1;
  const double half = std::isfinite(error) ? deviations[std::min(place, deviations.size() - 1)] : kNaN;
  tests.difference.push_back(difference);
  tests.error.push_back(error);
  tests.degrees.push_back(kNaN);
  tests.t.push_back(difference / error);
  tests.p.push_back(std::isfinite(error) ? (1 + n * share_at_least(deviations, difference)) / (1 + n) : kNaN);
  tests.low.push_back(difference - half);
  tests.high.push_back(difference + half);
}

/// The largest values of each sample over the surface; the observed ones are among them.
void set_family_wise(SurfaceTest& test, const MeshGraph& graph) {
  const std::size_t n = graph.n_vertices(), n_samples = test.deviations.size() / n;
  std::vector<double> max_t(n_samples + 1), max_tfce(n_samples + 1);
  const CancelRequest cancel;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t b = 0; b < n_samples; ++b) {
    if (cancel.made()) continue;
    std::vector<double> t(n);
    for (std::size_t v = 0; v < n; ++v) t[v] = static_cast<double>(test.deviations[b * n + v]) / test.vertices.error[v];
    max_t[b] = largest_magnitude(t);
    max_tfce[b] = largest_magnitude(enhance_clusters(t, graph));
  }
  cancel.check();
  test.tfce = enhance_clusters(test.vertices.t, graph);
  max_t.back() = largest_magnitude(test.vertices.t);
  max_tfce.back() = largest_magnitude(test.tfce);
  test.p_max_t = shares_at_least(max_t, test.vertices.t, test.vertices.t);
  test.p_tfce = shares_at_least(max_tfce, test.tfce, test.vertices.t);
}

void set_mean_abs(SurfaceTest& test, const MeshGraph& graph) {
  const std::size_t n = graph.n_vertices(), n_samples = test.deviations.size() / n;
  test.mean_abs_difference = mean_abs(test.vertices.difference, graph);
  std::vector<double> under_null;
  for (std::size_t b = 0; b < n_samples; ++b)
    under_null.push_back(
        mean_abs(std::vector<double>(test.deviations.begin() + static_cast<std::ptrdiff_t>(b * n),
                                     test.deviations.begin() + static_cast<std::ptrdiff_t>((b + 1) * n)),
                 graph));
  std::sort(under_null.begin(), under_null.end());
  const double count = static_cast<double>(n_samples);
  test.mean_abs_difference_p = (1 + count * share_at_least(under_null, test.mean_abs_difference)) / (1 + count);
  test.mean_abs_difference_exchanged = under_null[n_samples / 2];
}

}  // namespace

SurfaceTest test_within_runs(const Columns& columns, const std::vector<ReplicateColumns>& replicates,
                             std::size_t n_first, const std::vector<char>& tested, const MeshGraph& graph,
                             const SurfaceTestOptions& options) {
  SurfaceTest test;
  test.inference = Inference::kWithinRuns;
  test.exact = false;
  const std::size_t n = graph.n_vertices(), n_samples = options.n_bootstrap;
  test.n_arrangements = n_samples;
  test.smallest_p = 1 / static_cast<double>(n_samples + 1);
  test.deviations.assign(n_samples * n, 0);
  std::vector<double> difference(n, 0);
  for (std::size_t r = 0; r < replicates.size(); ++r) {
    const double share =
        r < n_first ? -1.0 / static_cast<double>(n_first) : 1.0 / static_cast<double>(replicates.size() - n_first);
    test.block_lengths.push_back(block_length(replicates[r], tested));
    add_samples(columns, r, test.block_lengths.back(), share, n_samples, options.seed, tested, test.deviations);
    for (std::size_t v = 0; v < n; ++v) difference[v] += share * replicates[r].columns[v].mean;
  }
  std::vector<double> deviations(n_samples);
  for (std::size_t v = 0; v < n; ++v) {
    if (tested[v] == 0) difference[v] = kNaN;
    for (std::size_t b = 0; b < n_samples; ++b) {
      float& sample = test.deviations[b * n + v];
      sample = static_cast<float>(static_cast<double>(sample) - difference[v]);
      deviations[b] = static_cast<double>(sample);
    }
    add_bootstrapped(test.vertices, difference[v], deviations, options.confidence);
  }
  set_family_wise(test, graph);
  set_mean_abs(test, graph);
  return test;
}

PlaceTests test_places_by_bootstrap(const SurfaceTest& surface, const MeshGraph& graph,
                                    const std::vector<std::vector<std::uint32_t>>& members, double confidence) {
  PlaceTests tests;
  const std::size_t n = graph.n_vertices(), n_samples = surface.deviations.size() / n;
  for (const auto& vertices : members) {
    double area = 0, difference = 0;
    std::vector<double> deviations(n_samples, 0);
    for (const std::uint32_t v : vertices) {
      if (!std::isfinite(surface.vertices.t[v])) continue;
      area += graph.area[v];
      difference += graph.area[v] * surface.vertices.difference[v];
      for (std::size_t b = 0; b < n_samples; ++b)
        deviations[b] += graph.area[v] * static_cast<double>(surface.deviations[b * n + v]);
    }
    for (double& d : deviations) d /= area;
    if (area == 0) std::fill(deviations.begin(), deviations.end(), 0.0);
    add_bootstrapped(tests, area > 0 ? difference / area : kNaN, deviations, confidence);
  }
  return tests;
}

}  // namespace espdiff
