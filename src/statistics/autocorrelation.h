// autocorrelation.h: how much independent information a correlated time series holds.
#pragma once

#include <cstddef>
#include <vector>

namespace espdiff {

/// Statistical inefficiency g = 1 + 2 * (sum of the normalized autocorrelation function), the number of frames that
/// hold as much information as one independent sample; at least 1.
///
/// Geyer's initial monotone sequence estimator (Geyer 1992, Statistical Science 7:473): sums of two neighbouring
/// autocovariances are added while they are positive, none larger than the one before. Autocovariances at lag k are
/// divided by the number of frames, which damps long lags.
/// @param values [frame]; NaN is a missing value: products with it count as zero, scaled by the number of pairs present
/// @returns NaN for less than two values, and where they are all equal
double statistical_inefficiency(const std::vector<double>& values);

/// One time series in numbers. Missing values (NaN) do not count.
struct SeriesSummary {
  std::size_t n = 0;           ///< values that are present
  double mean = 0;             ///< NaN without a value
  double variance = 0;         ///< of single values, with n - 1; NaN below two values
  double inefficiency = 0;     ///< see statistical_inefficiency()
  double effective = 0;        ///< effective samples, n / inefficiency; NaN where that is
  double error = 0;            ///< standard error of the mean, sqrt(variance / effective)
  double error_by_blocks = 0;  ///< the same from block averages, as a check; see error_by_blocks()
};
SeriesSummary summarize_series(const std::vector<double>& values);

/// Number of blocks of error_by_blocks().
constexpr std::size_t kBlocks = 10;

/// Standard error of the mean from the averages of ten consecutive blocks of equal length; a remainder at the start is
/// left out. It is right where blocks are much longer than the correlation.
/// @returns NaN for less than 2 * kBlocks values
double error_by_blocks(const std::vector<double>& values);

/// The first frame of the equilibrated part: the one that leaves the most effective samples (Chodera 2016, J. Chem.
/// Theory Comput. 12:1799). Candidates are 50 starts, evenly spaced.
/// @param values [frame], finite
/// @returns 0 where the values are all equal, or are less than 10
std::size_t detect_equilibration(const std::vector<double>& values);

}  // namespace espdiff
