// permutations.cpp: how labels of replicates can be exchanged.
#include "statistics/permutations.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "statistics/false_discovery.h"

using namespace espdiff;

TEST_SUITE_BEGIN("permutations");

TEST_CASE("few replicates allow few permutations, which bound p") {
  CHECK(count_permutations(3, 3) == 20);
  CHECK(count_permutations(4, 4) == 70);
  CHECK(count_permutations(2, 5) == 21);
  CHECK(count_permutations(500, 500) == std::uint64_t{1} << 63);
  CHECK(smallest_p(3, 3) == doctest::Approx(0.1));
  CHECK(smallest_p(4, 4) == doctest::Approx(2.0 / 70));
  CHECK(smallest_p(2, 5) == doctest::Approx(1.0 / 21));
  CHECK(smallest_p(20, 20) == doctest::Approx(1e-4));
}

TEST_CASE("all permutations are listed once, the observed one first") {
  const Permutations all = make_permutations(3, 4);
  CHECK(all.exact);
  CHECK(all.smallest_p() == doctest::Approx(1.0 / 35));
  REQUIRE(all.orders.size() == 35);
  CHECK(all.orders.front() == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6});
  const std::set<std::vector<std::uint32_t>> different(all.orders.begin(), all.orders.end());
  CHECK(different.size() == 35);
  for (std::vector<std::uint32_t> order : all.orders) {
    CHECK(std::is_sorted(order.begin(), order.begin() + 3));
    CHECK(std::is_sorted(order.begin() + 3, order.end()));
    std::sort(order.begin(), order.end());
    CHECK(order == all.orders.front());
  }
}

TEST_CASE("many permutations are sampled, each replicate as often in each group") {
  const Permutations all = make_permutations(10, 10, 4000, 7);
  CHECK_FALSE(all.exact);
  REQUIRE(all.orders.size() == 4000);
  CHECK(all.smallest_p() == doctest::Approx(1.0 / 4000));
  std::vector<int> in_first(20, 0);
  for (const auto& order : all.orders) {
    for (int i = 0; i < 10; ++i) ++in_first[order[static_cast<std::size_t>(i)]];
  }
  // Binomial(4000, 1/2): five standard deviations are 158.
  for (const int n : in_first) CHECK(std::abs(n - 2000) < 158);
  CHECK(make_permutations(10, 10, 4000, 7).orders == all.orders);
  CHECK(make_permutations(10, 10, 4000, 8).orders != all.orders);
}

TEST_CASE("false discovery rate: the values of scipy") {
  // scipy 1.17: false_discovery_control([0.01, 0.04, 0.03, 0.2, 0.005])
  const std::vector<double> adjusted = adjust_for_false_discovery({0.01, 0.04, 0.03, 0.2, 0.005});
  const std::vector<double> expected = {0.025, 0.05, 0.05, 0.2, 0.025};
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(adjusted[i] == doctest::Approx(expected[i]));
}

TEST_CASE("what was not tested does not count among the discoveries") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> adjusted = adjust_for_false_discovery({none, 0.01, none, 0.02});
  CHECK(std::isnan(adjusted[0]));
  CHECK(adjusted[1] == doctest::Approx(0.02));
  CHECK(adjusted[3] == doctest::Approx(0.02));
}

TEST_SUITE_END();
