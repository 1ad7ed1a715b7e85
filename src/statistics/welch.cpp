// welch.cpp: Student's distribution is Boost.Math's.
#include "statistics/welch.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "base/not_a_number.h"

namespace espdiff {
namespace {

/// Rounding of equal values is no variance.
double standard_error(const GroupMoments& a, const GroupMoments& b) {
  if (a.n < 2 || b.n < 2) return kNaN;
  const double error = std::sqrt(a.variance / static_cast<double>(a.n) + b.variance / static_cast<double>(b.n));
  const double rounding = 1e-12 * (std::fabs(a.mean) + std::fabs(b.mean));
  return error > rounding ? error : kNaN;
}
}  // namespace

GroupMoments group_moments(const double* values, std::size_t n) {
  GroupMoments m;
  m.n = n;
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += values[i];
  m.mean = sum / static_cast<double>(n);
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) squares += (values[i] - m.mean) * (values[i] - m.mean);
  m.variance = n < 2 ? kNaN : squares / static_cast<double>(n - 1);
  return m;
}

double welch_t(const GroupMoments& first, const GroupMoments& second) {
  return (second.mean - first.mean) / standard_error(first, second);
}

WelchTest welch_test(const GroupMoments& first, const GroupMoments& second) {
  WelchTest test;
  test.difference = second.mean - first.mean;
  test.error = standard_error(first, second);
  test.t = welch_t(first, second);
  const double a = first.variance / static_cast<double>(first.n), b = second.variance / static_cast<double>(second.n);
  test.degrees =
      (a + b) * (a + b) / (a * a / static_cast<double>(first.n - 1) + b * b / static_cast<double>(second.n - 1));
  if (!std::isfinite(test.t)) test.degrees = kNaN;
  test.p = student_p(test.t, test.degrees);
  return test;
}

double student_quantile(double confidence, double degrees) {
  if (!(degrees > 0)) return kNaN;
  return boost::math::quantile(boost::math::complement(boost::math::students_t(degrees), (1 - confidence) / 2));
}

double student_p(double t, double degrees) {
  if (!(degrees > 0) || !std::isfinite(t)) return kNaN;
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(degrees), std::fabs(t)));
}

}  // namespace espdiff
