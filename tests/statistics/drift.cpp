// drift.cpp: runs with and without a trend, and how often one without is taken for one with it.
#include "statistics/drift.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "statistics/autocorrelation.h"
#include "statistics/columns.h"
#include "statistics/planted_columns.h"
#include "statistics/replicate_columns.h"

using namespace espdiff;
using espdiff_test::correlated_series;
using espdiff_test::Normal;

namespace {

constexpr std::size_t kColumns = 50;

/// Block means of columns of correlated noise with a trend from 0 to `rise`.
std::vector<double> blocks_of(std::size_t n_frames, double phi, double rise, std::uint64_t seed) {
  std::vector<float> values(n_frames * kColumns);
  for (std::size_t c = 0; c < kColumns; ++c) {
    Normal normal(seed, c);
    const std::vector<double> series = correlated_series(n_frames, phi, normal);
    for (std::size_t f = 0; f < n_frames; ++f)
      values[f * kColumns + c] =
          static_cast<float>(series[f] + rise * static_cast<double>(f) / static_cast<double>(n_frames - 1));
  }
  ColumnsInMemory columns(kColumns);
  columns.add_replicate(values);
  return summarize_columns(columns).front().blocks;
}

const std::vector<double> kEqual(kColumns, 1.0);

}  // namespace

TEST_SUITE_BEGIN("drift");

TEST_CASE("a straight line is all trend, and no order of its blocks but the reverse is as strong") {
  std::vector<double> blocks;
  for (std::size_t b = 0; b < kBlocks; ++b) blocks.push_back(3 + 2 * static_cast<double>(b));
  const Drift drift = measure_drift(blocks, {1});
  CHECK(drift.share == doctest::Approx(1));
  CHECK(drift.p == doctest::Approx(1e-4));
}

TEST_CASE("without a trend, p is uniform: the share of small ones is as large as they are") {
  constexpr int kRepeats = 400;
  int below = 0, tenth = 0;
  double share = 0;
  for (int k = 0; k < kRepeats; ++k) {
    const Drift drift = measure_drift(blocks_of(200, 0, 0, static_cast<std::uint64_t>(k)), kEqual);
    below += drift.p <= 0.01 ? 1 : 0;
    tenth += drift.p <= 0.1 ? 1 : 0;
    share += drift.share / kRepeats;
  }
  // Binomial: 1 % of 400 are 4 +- 2, 10 % are 40 +- 6; three standard deviations.
  MESSAGE("p <= 0.01 in ", below, ", p <= 0.1 in ", tenth, " of ", kRepeats);
  CHECK(below <= 10);
  CHECK(std::abs(tenth - 40) <= 18);
  CHECK(share == doctest::Approx(1.0 / (kBlocks - 1)).epsilon(0.05));
}

TEST_CASE("a trend of one standard deviation of a frame is found under noise that is correlated") {
  const Drift drift = measure_drift(blocks_of(200, 0.6, 1, 7), kEqual);
  CHECK(drift.p < 0.001);
  CHECK(drift.share > 0.2);
  CHECK(measure_drift(blocks_of(200, 0.6, 0, 7), kEqual).p > 0.01);
}

TEST_CASE("too few frames, equal values and columns that do not count have no drift") {
  CHECK(std::isnan(measure_drift(blocks_of(9, 0, 1, 1), kEqual).p));
  CHECK(std::isnan(measure_drift(std::vector<double>(kBlocks, 2), {1}).p));
  CHECK(std::isnan(measure_drift(blocks_of(20, 0, 1, 1), std::vector<double>(kColumns, 0)).p));
  std::vector<double> blocks = blocks_of(20, 0, 5, 1);
  const Drift whole = measure_drift(blocks, kEqual);
  std::vector<double> weights = kEqual;
  blocks.insert(blocks.end(), kBlocks, std::numeric_limits<double>::quiet_NaN());
  weights.push_back(1);
  CHECK(measure_drift(blocks, weights).p == whole.p);
}

TEST_SUITE_END();
