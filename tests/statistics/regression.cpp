// regression.cpp: correlations by hand, false alarms, and predictions of values that the surface has and has not.
#include "statistics/regression.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "statistics/planted_columns.h"
#include "statistics/surface/mesh_graph.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::make_ellipsoid;
using espdiff_test::message_of;
using espdiff_test::Normal;

namespace {

struct Surface {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  MeshGraph graph;
  explicit Surface(int levels) {
    make_ellipsoid(levels, positions, triangles);
    graph = make_mesh_graph(positions, triangles);
  }
  bool is_inside(std::size_t v) const { return positions[v].x > 8; }
  /// Noise of unit variance; `effect` times the replicate's value where it is planted.
  std::vector<std::vector<double>> means(const std::vector<double>& values, double effect, std::uint64_t seed) const {
    std::vector<std::vector<double>> all;
    for (std::size_t r = 0; r < values.size(); ++r) {
      Normal normal(seed, r);
      all.emplace_back();
      for (std::size_t v = 0; v < positions.size(); ++v)
        all.back().push_back(normal.next() + (is_inside(v) ? effect * values[r] : 0));
    }
    return all;
  }
};

const std::vector<double> kValues = {0.3, 1.7, 2.2, 3.1, 4.4, 5.2, 6.8};

}  // namespace

TEST_SUITE_BEGIN("regression");

TEST_CASE("correlation, slope, t and p are Pearson's") {
  const Surface s(1);
  const std::vector<double> y = {1, 2, 4, 5, 8};
  std::vector<std::vector<double>> means(5, std::vector<double>(s.positions.size()));
  const std::vector<double> x = {2.1, 3.9, 4.2, 7.7, 8.4};
  for (std::size_t r = 0; r < 5; ++r) {
    for (std::size_t v = 0; v < s.positions.size(); ++v)
      means[r][v] = v == 0 ? x[r] : std::sin(static_cast<double>(7 * r + v));
  }
  const SurfaceRegression fit = regress_on_surface(means, y, s.graph, {});
  // scipy.stats.linregress([1, 2, 4, 5, 8], [2.1, 3.9, 4.2, 7.7, 8.4])
  CHECK(fit.slope[0] == doctest::Approx(0.906667).epsilon(1e-5));
  CHECK(fit.correlation[0] == doctest::Approx(0.9258129).epsilon(1e-6));
  CHECK(fit.p[0] == doctest::Approx(0.0239846).epsilon(1e-5));
  CHECK(fit.t[0] == doctest::Approx(fit.correlation[0] * std::sqrt(3 / (1 - fit.correlation[0] * fit.correlation[0]))));
  CHECK(fit.n_permutations == 120);
  CHECK(fit.exact);
  CHECK(fit.smallest_p == doctest::Approx(1.0 / 120));
}

TEST_CASE("a planted value is found where it is, and predicted from the other replicates") {
  const Surface s(2);
  const SurfaceRegression fit = regress_on_surface(s.means(kValues, 2, 3), kValues, s.graph, {});
  double inside = 0, found = 0, outside = 0, n_outside = 0;
  for (std::size_t v = 0; v < s.positions.size(); ++v) {
    (s.is_inside(v) ? inside : n_outside) += 1;
    if (fit.p_tfce[v] <= 0.05) (s.is_inside(v) ? found : outside) += 1;
  }
  CHECK(found > 0.9 * inside);
  CHECK(outside < 0.1 * n_outside);
  CHECK(fit.q2 > 0.9);
  CHECK(fit.q2_p < 0.01);
  for (std::size_t r = 0; r < kValues.size(); ++r)
    CHECK(fit.predicted[r] == doctest::Approx(kValues[r]).scale(5).epsilon(0.2));
}

TEST_CASE("a replicate is predicted without its own value") {
  const Surface s(1);
  std::vector<double> values = kValues;
  const auto means = s.means(kValues, 2, 5);
  const double before = regress_on_surface(means, values, s.graph, {}).predicted[3];
  values[3] = 100;
  CHECK(regress_on_surface(means, values, s.graph, {}).predicted[3] == doctest::Approx(before));
}

TEST_CASE("without an effect, false alarms come at the rate of alpha, and nothing is predicted") {
  const Surface s(1);
  constexpr int kRepeats = 400;
  const std::vector<double> values = {0.3, 1.7, 2.2, 3.1, 4.4};
  int n_max_t = 0, n_tfce = 0, n_q2 = 0;
  for (int k = 0; k < kRepeats; ++k) {
    const SurfaceRegression fit =
        regress_on_surface(s.means(values, 0, 100 + static_cast<std::uint64_t>(k)), values, s.graph, {});
    n_max_t += *std::min_element(fit.p_max_t.begin(), fit.p_max_t.end()) <= 0.05 ? 1 : 0;
    n_tfce += *std::min_element(fit.p_tfce.begin(), fit.p_tfce.end()) <= 0.05 ? 1 : 0;
    n_q2 += fit.q2_p <= 0.05 ? 1 : 0;
  }
  // 5 values have 120 orders: 5 % of 400 are 20 +- 4.4; three standard deviations.
  MESSAGE("false alarms: max-t ", n_max_t, ", TFCE ", n_tfce, ", Q2 ", n_q2, " of ", kRepeats, "; expected 20");
  CHECK(std::abs(n_max_t - 20) <= 13);
  CHECK(std::abs(n_tfce - 20) <= 13);
  CHECK(std::abs(n_q2 - 20) <= 13);
}

TEST_CASE("replicates without a value, and places without a column, do not count") {
  const Surface s(1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values = kValues;
  auto means = s.means(kValues, 2, 3);
  values.push_back(nan);
  means.push_back(std::vector<double>(s.positions.size(), 99));
  means[2][4] = nan;
  const SurfaceRegression fit = regress_on_surface(means, values, s.graph, {});
  CHECK(std::isnan(fit.predicted.back()));
  CHECK(std::isnan(fit.correlation[4]));
  CHECK(std::isnan(fit.p_tfce[4]));
  const SurfaceRegression without = regress_on_surface(s.means(kValues, 2, 3), kValues, s.graph, {});
  CHECK(fit.correlation[5] == without.correlation[5]);
}

TEST_CASE("what cannot be regressed is refused") {
  const Surface s(1);
  const std::vector<double> three = {1, 2, 3}, equal = {2, 2, 2, 2};
  CHECK(message_of([&] { regress_on_surface(s.means(three, 0, 1), three, s.graph, {}); }) ==
        "a regression needs the values of 4 replicates or more, and there are 3");
  CHECK(message_of([&] { regress_on_surface(s.means(equal, 0, 1), equal, s.graph, {}); }) ==
        "a regression needs values that differ; all 4 are equal");
}

TEST_SUITE_END();
