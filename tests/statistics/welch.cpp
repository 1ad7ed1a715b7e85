// welch.cpp: Welch's test against values of scipy.stats.
#include "statistics/welch.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace espdiff;

TEST_SUITE_BEGIN("welch");

TEST_CASE("t, p and interval are those of scipy") {
  // scipy 1.17: r = ttest_ind([3.0, 2.2, 4.1], [1.1, 1.9, 2.4, 0.7], equal_var=False);
  //             r.statistic, r.pvalue, r.df, r.confidence_interval(0.95)
  const std::vector<double> a = {1.1, 1.9, 2.4, 0.7}, b = {3.0, 2.2, 4.1};
  const WelchTest test = welch_test(group_moments(a.data(), 4), group_moments(b.data(), 3));
  CHECK(test.t == doctest::Approx(2.34624260658016).epsilon(1e-12));
  CHECK(test.p == doctest::Approx(0.0820173784386772).epsilon(1e-10));
  CHECK(test.degrees == doctest::Approx(3.81430682983342).epsilon(1e-12));
  const double half = student_quantile(0.95, test.degrees) * test.error;
  CHECK(test.difference - half == doctest::Approx(-0.325124407470888).epsilon(1e-10));
  CHECK(test.difference + half == doctest::Approx(3.47512440747089).epsilon(1e-10));
}

TEST_CASE("exchanging the groups turns the sign of t, bit for bit") {
  const std::vector<double> a = {0.3, -1.7, 2.9}, b = {0.1, 0.7, 5.3, 1.1};
  const GroupMoments first = group_moments(a.data(), 3), second = group_moments(b.data(), 4);
  CHECK(welch_t(first, second) == -welch_t(second, first));
}

TEST_CASE("without variance, or with one value, there is no test") {
  const std::vector<double> equal = {2, 2, 2}, others = {2.5, 2.5}, one = {1};
  const auto is_undefined = [](const WelchTest& test) {
    return std::isnan(test.t) && std::isnan(test.p) && std::isnan(test.degrees);
  };
  CHECK(is_undefined(welch_test(group_moments(equal.data(), 3), group_moments(others.data(), 2))));
  CHECK(is_undefined(welch_test(group_moments(equal.data(), 3), group_moments(one.data(), 1))));
  CHECK(std::isnan(student_quantile(0.95, 0)));
}

TEST_SUITE_END();
