// weighted_correlation.cpp: Pearson's and Spearman's correlation with weights.
#include "complementarity/weighted_correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace espdiff {
namespace {

std::vector<double> weighted_ranks(const std::vector<double>& values, const std::vector<double>& weight) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  std::vector<double> ranks(values.size());
  double below = 0;
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    double equal = 0;
    for (; end < order.size() && values[order[end]] == values[order[begin]]; ++end) equal += weight[order[end]];
    for (; begin < end; ++begin) ranks[order[begin]] = below + equal / 2;
    below += equal;
  }
  return ranks;
}

}  // namespace

std::vector<double> standardized(const std::vector<double>& values, const std::vector<double>& weight) {
  double total = 0, mean = 0, variance = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    total += weight[i];
    mean += weight[i] * values[i];
  }
  mean /= total;
  for (std::size_t i = 0; i < values.size(); ++i) variance += weight[i] * (values[i] - mean) * (values[i] - mean);
  const double deviation = std::sqrt(variance / total);
  std::vector<double> result;
  for (const double value : values) result.push_back(deviation > 0 ? (value - mean) / deviation : std::nan(""));
  return result;
}

double weighted_pearson(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& weight) {
  const std::vector<double> x = standardized(a, weight), y = standardized(b, weight);
  double total = 0, sum = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    total += weight[i];
    sum += weight[i] * x[i] * y[i];
  }
  return sum / total;
}

double weighted_spearman(const std::vector<double>& a, const std::vector<double>& b,
                         const std::vector<double>& weight) {
  return weighted_pearson(weighted_ranks(a, weight), weighted_ranks(b, weight), weight);
}

}  // namespace espdiff
