// drift.cpp: the trend of block averages, and its permutation test on their products.
#include "statistics/drift.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/counter_random.h"
#include "statistics/autocorrelation.h"

namespace espdiff {
namespace {

/// Sums over columns of products of two blocks' deviations from the column's mean: all that any order of them needs.
using Products = std::array<std::array<double, kBlocks>, kBlocks>;
using BlockOrder = std::array<std::size_t, kBlocks>;

Products products_of(const std::vector<double>& blocks, const std::vector<double>& weights) {
  Products products{};
  for (std::size_t c = 0; c < weights.size(); ++c) {
    const double* const means = &blocks[c * kBlocks];
    const double mean = std::accumulate(means, means + kBlocks, 0.0) / kBlocks;
    if (weights[c] == 0 || !std::isfinite(mean)) continue;
    for (std::size_t a = 0; a < kBlocks; ++a) {
      for (std::size_t b = 0; b < kBlocks; ++b) products[a][b] += weights[c] * (means[a] - mean) * (means[b] - mean);
    }
  }
  return products;
}

/// The share of the variance that a straight line through the blocks explains.
double trend_of(const Products& products, const BlockOrder& order) {
  const auto step = [](std::size_t place) { return static_cast<double>(place) - (kBlocks - 1) / 2.0; };
  double explained = 0, squares = 0, variance = 0;
  for (std::size_t a = 0; a < kBlocks; ++a) {
    squares += step(a) * step(a);
    variance += products[a][a];
    for (std::size_t b = 0; b < kBlocks; ++b) explained += step(a) * step(b) * products[order[a]][order[b]];
  }
  return explained / squares / variance;
}

/// The order of Fisher and Yates.
BlockOrder random_order(std::uint64_t seed, std::uint64_t number) {
  BlockOrder order;
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = kBlocks - 1; i > 0; --i) std::swap(order[i], order[random_below(i + 1, seed, number, i)]);
  return order;
}

}  // namespace

Drift measure_drift(const std::vector<double>& blocks, const std::vector<double>& weights, std::uint64_t seed) {
  const Products products = products_of(blocks, weights);
  BlockOrder observed;
  std::iota(observed.begin(), observed.end(), std::size_t{0});
  Drift drift;
  drift.share = trend_of(products, observed);
  if (!std::isfinite(drift.share)) return {drift.share, std::numeric_limits<double>::quiet_NaN()};
  std::size_t n_as_strong = 1;  // the observed order
  for (std::size_t k = 0; k < kOrdersOfBlocks; ++k)
    n_as_strong += trend_of(products, random_order(seed, k)) >= drift.share * (1 - 1e-9) ? 1U : 0U;
  drift.p = static_cast<double>(n_as_strong) / static_cast<double>(kOrdersOfBlocks + 1);
  return drift;
}

}  // namespace espdiff
