// weighted_correlation.h: correlations of two columns of values with weights.
#pragma once

#include <vector>

namespace espdiff {

/// Pearson's correlation. NaN where a column does not vary.
double weighted_pearson(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& weight);

/// Spearman's: Pearson's of the ranks. A rank is the weight of all smaller values and half of that of equal ones, which
/// for equal weights is the usual mean rank.
double weighted_spearman(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& weight);

/// Each value less the weighted mean, over the weighted standard deviation.
std::vector<double> standardized(const std::vector<double>& values, const std::vector<double>& weight);

}  // namespace espdiff
