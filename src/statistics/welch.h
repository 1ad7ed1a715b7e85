// welch.h: Welch's t-test of two groups, and its confidence interval.
#pragma once

#include <cstddef>

namespace espdiff {

/// Sums of a group's values.
struct GroupMoments {
  double mean = 0;
  double variance = 0;  ///< with n - 1
  std::size_t n = 0;
};
/// Two passes, in the order of the values.
GroupMoments group_moments(const double* values, std::size_t n);

/// Difference of two groups' means, without assuming equal variances.
struct WelchTest {
  double difference = 0;  ///< of the means, second - first
  double error = 0;       ///< its standard error
  double t = 0;
  double degrees = 0;  ///< of freedom, Welch-Satterthwaite
  double p = 1;        ///< two-sided
};

/// Welch 1947, Biometrika 34:28. All but the difference is NaN if a group has less than two values or neither varies.
WelchTest welch_test(const GroupMoments& first, const GroupMoments& second);
/// t alone, which permutations need; the same bits as in welch_test().
double welch_t(const GroupMoments& first, const GroupMoments& second);

/// Half the width of Student's confidence interval in standard errors.
/// @param confidence such as 0.95
/// @returns NaN unless degrees > 0
double student_quantile(double confidence, double degrees);
/// Two-sided p of Student's t; NaN unless degrees > 0 and t is a number.
double student_p(double t, double degrees);

}  // namespace espdiff
