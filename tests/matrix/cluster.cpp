// cluster.cpp: average linkage against a textbook's and a slow, obvious computation; correlations of known series.
#include "matrix/cluster.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/random.h"

using namespace espdiff;  // NOLINT: a test of one header
using espdiff_test::Random;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The mean distance of every variant of one cluster to every one of the other, from the table itself.
double mean_distance(const DistanceTable& d, std::size_t n, const std::vector<std::size_t>& a,
                     const std::vector<std::size_t>& b) {
  double sum = 0;
  for (const std::size_t i : a) {
    for (const std::size_t j : b) sum += d[i * n + j];
  }
  return sum / static_cast<double>(a.size() * b.size());
}

}  // namespace

TEST_SUITE_BEGIN("cluster");

TEST_CASE("five things cluster as worked out by hand") {
  // Sokal and Michener's method on a table whose steps are: 0+1 at 2, 3+4 at 3, 2+(3,4) at 4.5, the rest at
  // (6 + 5 + 10 + 9 + 9 + 8) / 6.
  const DistanceTable d = {0, 2, 6, 10, 9, 2, 0, 5, 9, 8, 6, 5, 0, 4, 5, 10, 9, 4, 0, 3, 9, 8, 5, 3, 0};
  const auto merges = average_linkage(d, 5);
  REQUIRE(merges.size() == 4);
  CHECK(merges[0].left == 0);
  CHECK(merges[0].right == 1);
  CHECK(merges[1].left == 3);
  CHECK(merges[1].right == 4);
  CHECK(merges[2].left == 2);
  CHECK(merges[2].right == 6);
  CHECK(merges[2].distance == doctest::Approx(4.5));
  CHECK(merges[3].distance == doctest::Approx(47.0 / 6));
  CHECK(merges[3].n_variants == 5);
  CHECK(dendrogram_order(merges, 5) == std::vector<std::size_t>{0, 1, 2, 3, 4});
}

TEST_CASE("each merge is at the mean distance of its members, the least of all, and never nearer than one before") {
  Random random(7);
  const std::size_t n = 23;
  DistanceTable d(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) d[i * n + j] = d[j * n + i] = random.uniform(0.1, 5);
  }
  const auto merges = average_linkage(d, n);
  REQUIRE(merges.size() == n - 1);
  std::vector<std::vector<std::size_t>> members(n), alive;
  for (std::size_t i = 0; i < n; ++i) members[i] = {i};
  alive = members;
  double before = 0;
  for (const ClusterMerge& merge : merges) {
    const auto a = members[merge.left], b = members[merge.right];
    CHECK(merge.distance == doctest::Approx(mean_distance(d, n, a, b)));
    for (const auto& x : alive) {
      for (const auto& y : alive) {
        if (x < y) CHECK(mean_distance(d, n, x, y) >= merge.distance * (1 - 1e-12));
      }
    }
    CHECK(merge.distance >= before);
    before = merge.distance;
    std::vector<std::size_t> joined = a;
    joined.insert(joined.end(), b.begin(), b.end());
    CHECK(*std::min_element(a.begin(), a.end()) < *std::min_element(b.begin(), b.end()));
    alive.erase(std::remove_if(alive.begin(), alive.end(), [&](const auto& c) { return c == a || c == b; }),
                alive.end());
    alive.push_back(joined);
    members.push_back(joined);
  }
  std::vector<std::size_t> order = dendrogram_order(merges, n);
  CHECK(order == members.back());
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < n; ++i) CHECK(order[i] == i);
}

TEST_CASE("of equal distances the smallest numbers merge first") {
  const std::size_t n = 4;
  DistanceTable d(n * n, 1.0);
  const auto merges = average_linkage(d, n);
  CHECK(merges[0].left == 0);
  CHECK(merges[0].right == 1);
  CHECK(merges[1].left == 4);
  CHECK(merges[1].right == 2);
  CHECK(merges[2].left == 5);
  CHECK(merges[2].right == 3);
}

TEST_CASE("distances that are not known are left out of the means, and merge last where none is known") {
  const DistanceTable d = {0, 1, kNan, kNan, 1, 0, 3, kNan, kNan, 3, 0, kNan, kNan, kNan, kNan, 0};
  const auto merges = average_linkage(d, 4);
  CHECK(merges[1].distance == doctest::Approx(3));
  CHECK(std::isnan(merges[2].distance));
  CHECK(dendrogram_order(merges, 4) == std::vector<std::size_t>{0, 1, 2, 3});
}

TEST_CASE("correlations of series that rise together, oppose each other, or do not say") {
  const std::vector<double> a = {1, 2, 3, 4, 5}, squares = {1, 4, 9, 16, 25}, down = {5, 4, 3, 2, 1};
  CHECK(correlation(a, a) == doctest::Approx(1));
  CHECK(correlation(a, down) == doctest::Approx(-1));
  CHECK(correlation(a, squares) == doctest::Approx(0.9811).epsilon(1e-4));
  CHECK(rank_correlation(a, squares) == doctest::Approx(1));
  // Ties share their rank: ranks 0 1.5 1.5 3 against 0 1 2 3.
  CHECK(rank_correlation({1, 2, 2, 3}, {1, 2, 3, 4}) == doctest::Approx(std::sqrt(0.9)));
  CHECK(correlation({1, kNan, 2, 3}, {2, 9, 4, 6}) == doctest::Approx(1));
  CHECK(std::isnan(correlation({1, 2}, {1, 2})));
  CHECK(std::isnan(correlation({1, 1, 1}, {1, 2, 3})));
}

TEST_SUITE_END();
