// autocorrelation.cpp: statistical inefficiency, block averages and the equilibrated part of a time series.
#include "statistics/autocorrelation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/not_a_number.h"

namespace espdiff {
namespace {

struct Moments {
  std::size_t n = 0;
  double mean = kNaN, sum_of_squares = 0;  // about the mean
};

Moments moments_of(const double* values, std::size_t n_values) {
  Moments m;
  double sum = 0;
  for (std::size_t i = 0; i < n_values; ++i) {
    if (!std::isfinite(values[i])) continue;
    sum += values[i];
    ++m.n;
  }
  if (m.n == 0) return m;
  m.mean = sum / static_cast<double>(m.n);
  for (std::size_t i = 0; i < n_values; ++i) {
    if (std::isfinite(values[i])) m.sum_of_squares += (values[i] - m.mean) * (values[i] - m.mean);
  }
  return m;
}

/// Rounding of equal values is no variance.
bool is_constant(const Moments& m) {
  const double scale = std::fabs(m.mean) * 1e-12;
  return m.sum_of_squares <= static_cast<double>(m.n) * scale * scale;
}

/// Deviations from the mean, zero where a value is missing, with the number of values.
struct Deviations {
  std::vector<double> values;
  std::vector<char> present;
  bool complete = true;

  /// Autocovariance at a lag, divided by the number of frames.
  double covariance(std::size_t lag) const {
    const std::size_t n = values.size();
    double sum = 0;
    for (std::size_t i = 0; i + lag < n; ++i) sum += values[i] * values[i + lag];
    if (complete) return sum / static_cast<double>(n);
    std::size_t pairs = 0;
    for (std::size_t i = 0; i + lag < n; ++i) pairs += present[i] & present[i + lag] ? 1U : 0U;
    if (pairs == 0) return 0;
    return sum / static_cast<double>(pairs) * static_cast<double>(n - lag) / static_cast<double>(n);
  }
};

double inefficiency(const double* values, std::size_t n_values) {
  const Moments m = moments_of(values, n_values);
  if (m.n < 2 || is_constant(m)) return kNaN;
  Deviations d;
  d.values.resize(n_values);
  d.present.resize(n_values);
  for (std::size_t i = 0; i < n_values; ++i) {
    d.present[i] = std::isfinite(values[i]) ? 1 : 0;
    d.values[i] = d.present[i] != 0 ? values[i] - m.mean : 0;
    d.complete = d.complete && d.present[i] != 0;
  }
  const double variance = d.covariance(0);
  double sum = 0, before = std::numeric_limits<double>::infinity();
  for (std::size_t lag = 0; lag + 1 < n_values; lag += 2) {
    const double pair = (lag == 0 ? variance : d.covariance(lag)) + d.covariance(lag + 1);
    if (pair <= 0) break;
    before = std::min(before, pair);
    sum += before;
  }
  return std::max(1.0, 2 * sum / variance - 1);
}

}  // namespace

double statistical_inefficiency(const std::vector<double>& values) {
  return inefficiency(values.data(), values.size());
}

double error_by_blocks(const std::vector<double>& values) {
  const std::size_t length = values.size() / kBlocks, skipped = values.size() - length * kBlocks;
  if (length < 2) return kNaN;
  std::vector<double> averages;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const Moments m = moments_of(values.data() + skipped + block * length, length);
    if (m.n > 0) averages.push_back(m.mean);
  }
  const Moments m = moments_of(averages.data(), averages.size());
  if (m.n < 2) return kNaN;
  return std::sqrt(m.sum_of_squares / static_cast<double>(m.n - 1) / static_cast<double>(m.n));
}

SeriesSummary summarize_series(const std::vector<double>& values) {
  const Moments m = moments_of(values.data(), values.size());
  SeriesSummary s;
  s.n = m.n;
  s.mean = m.mean;
  s.variance = m.n < 2 ? kNaN : m.sum_of_squares / static_cast<double>(m.n - 1);
  s.inefficiency = statistical_inefficiency(values);
  s.effective = static_cast<double>(m.n) / s.inefficiency;
  s.error = std::sqrt(s.variance / s.effective);
  s.error_by_blocks = error_by_blocks(values);
  return s;
}

std::size_t detect_equilibration(const std::vector<double>& values) {
  constexpr std::size_t kCandidates = 50, kFewest = 10;
  const std::size_t n = values.size();
  if (n < kFewest) return 0;
  std::size_t best = 0, before = n;
  double most = 0;
  for (std::size_t k = 0; k < kCandidates; ++k) {
    const std::size_t start = k * (n - kFewest) / kCandidates;
    if (start == before) continue;
    before = start;
    const double effective =
        static_cast<double>(n - start) / inefficiency(values.data() + start, n - start);  // NaN is not more
    if (effective > most) {
      most = effective;
      best = start;
    }
  }
  return best;
}

}  // namespace espdiff
