// autocorrelation.cpp: the information in correlated series of known correlation time.
#include "statistics/autocorrelation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "statistics/planted_columns.h"

using namespace espdiff;
using espdiff_test::correlated_series;
using espdiff_test::Normal;

TEST_SUITE_BEGIN("autocorrelation");

TEST_CASE("g of planted correlation is within 10 % of the exact value") {
  for (const double phi : {0.0, 0.5, 0.8, 0.95}) {
    const double exact = (1 + phi) / (1 - phi);
    double sum = 0;
    constexpr int kSeries = 100;
    for (int k = 0; k < kSeries; ++k) {
      Normal normal(11, static_cast<std::uint64_t>(k));
      sum += statistical_inefficiency(correlated_series(4000, phi, normal));
    }
    CAPTURE(phi);
    CHECK(sum / kSeries == doctest::Approx(exact).epsilon(0.1));
  }
}

TEST_CASE("the standard error of a correlated mean is that over repeats, and blocks agree") {
  constexpr int kRepeats = 400;
  double squares = 0, predicted = 0, by_blocks = 0;
  for (int k = 0; k < kRepeats; ++k) {
    Normal normal(12, static_cast<std::uint64_t>(k));
    const SeriesSummary s = summarize_series(correlated_series(2000, 0.8, normal));
    squares += s.mean * s.mean;
    predicted += s.error * s.error;
    by_blocks += s.error_by_blocks * s.error_by_blocks;
  }
  // The variance over 400 repeats is known to 7 %.
  CHECK(predicted / squares == doctest::Approx(1).epsilon(0.2));
  CHECK(by_blocks / squares == doctest::Approx(1).epsilon(0.2));
}

TEST_CASE("missing values do not change g beyond the noise") {
  double complete = 0, with_gaps = 0;
  for (std::uint64_t k = 0; k < 50; ++k) {
    Normal normal(13, k);
    std::vector<double> x = correlated_series(3000, 0.8, normal);
    complete += statistical_inefficiency(x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (random_below(100, 14, k, i) < 15) x[i] = std::numeric_limits<double>::quiet_NaN();
    }
    with_gaps += statistical_inefficiency(x);
  }
  CHECK(with_gaps / complete == doctest::Approx(1).epsilon(0.1));
}

TEST_CASE("g is at least 1, and is not defined for a constant") {
  std::vector<double> alternating(100);
  for (std::size_t i = 0; i < alternating.size(); ++i) alternating[i] = i % 2 == 0 ? 1 : -1;
  CHECK(statistical_inefficiency(alternating) == 1);
  CHECK(std::isnan(statistical_inefficiency(std::vector<double>(100, 0.1))));
  CHECK(statistical_inefficiency({1, 2}) == 1);
  CHECK(std::isnan(statistical_inefficiency({1})));
  const SeriesSummary none = summarize_series({});
  CHECK(none.n == 0);
  CHECK(std::isnan(none.mean));
}

TEST_CASE("the start of a relaxing series is cut off") {
  Normal normal(15, 0);
  std::vector<double> x = correlated_series(2000, 0.5, normal);
  CHECK(detect_equilibration(x) < 400);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 10 * std::exp(-static_cast<double>(i) / 100);
  const std::size_t start = detect_equilibration(x);
  CHECK(start >= 150);
  CHECK(start <= 800);
  CHECK(detect_equilibration({1, 2, 3}) == 0);
}

TEST_SUITE_END();
