// surface_test.cpp: two groups compared over a surface: determinism, missing values, places, one replicate a group.
#include "statistics/surface/surface_test.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "statistics/columns.h"
#include "statistics/control_together.h"
#include "statistics/planted_columns.h"
#include "statistics/replicate_columns.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/test_places.h"
#include "statistics/test_replicates.h"
#include "statistics/test_within_runs.h"
#include "statistics/welch.h"

using namespace espdiff;
using espdiff_test::correlated_series;
using espdiff_test::make_ellipsoid;
using espdiff_test::Normal;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

MeshGraph ellipsoid() {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  make_ellipsoid(2, positions, triangles);
  return make_mesh_graph(positions, triangles);
}

/// Correlated noise at each vertex; `effect` is added around vertex 0 in the second group.
ColumnsInMemory planted(const MeshGraph& graph, std::size_t n_replicates, std::size_t n_frames, double effect,
                        std::uint64_t seed) {
  ColumnsInMemory columns(graph.n_vertices());
  for (std::size_t r = 0; r < n_replicates; ++r) {
    std::vector<float> values(n_frames * graph.n_vertices());
    for (std::size_t v = 0; v < graph.n_vertices(); ++v) {
      Normal normal(seed, r * graph.n_vertices() + v);
      const std::vector<double> series = correlated_series(n_frames, 0.5, normal);
      for (std::size_t f = 0; f < n_frames; ++f) values[f * graph.n_vertices() + v] = static_cast<float>(series[f]);
    }
    for (std::size_t f = 0; f < n_frames && 2 * r >= n_replicates; ++f) {
      float* const row = values.data() + f * graph.n_vertices();
      row[0] += static_cast<float>(effect);
      for (std::uint32_t n = graph.first[0]; n < graph.first[1]; ++n)
        row[graph.neighbours[n]] += static_cast<float>(effect);
    }
    columns.add_replicate(std::move(values));
  }
  return columns;
}

std::vector<std::vector<double>> means_of(const std::vector<ReplicateColumns>& replicates) {
  std::vector<std::vector<double>> means;
  for (const ReplicateColumns& replicate : replicates) {
    means.emplace_back();
    for (const SeriesSummary& s : replicate.columns) means.back().push_back(s.mean);
  }
  return means;
}

}  // namespace

TEST_SUITE_BEGIN("surface test");

TEST_CASE("a planted patch is found, and nothing opposite") {
  const MeshGraph graph = ellipsoid();
  const auto means = means_of(summarize_columns(planted(graph, 10, 200, 1.5, 31)));
  const SurfaceTest test = test_replicates(means, 5, graph, {});
  CHECK(test.n_permutations == 252);
  CHECK(test.exact);
  CHECK(test.p_tfce[0] == doctest::Approx(2.0 / 252));
  CHECK(test.p_max_t[3] > 0.05);
  CHECK(test.vertices.low[0] < 1.5);
  CHECK(test.vertices.high[0] > 1.5);
  CHECK(test.mean_abs_difference_p == doctest::Approx(2.0 / 252));
}

TEST_CASE("vertices that are not tested have no p and do not join others") {
  const MeshGraph graph = ellipsoid();
  auto means = means_of(summarize_columns(planted(graph, 8, 100, 1.5, 32)));
  for (auto& replicate : means) replicate[0] = kNaN;
  const SurfaceTest test = test_replicates(means, 4, graph, {});
  CHECK(std::isnan(test.p_max_t[0]));
  CHECK(std::isnan(test.p_tfce[0]));
  CHECK(std::isfinite(test.p_tfce[1]));
}

TEST_CASE("a place's test is Welch's of the replicates' area-weighted means") {
  const MeshGraph graph = ellipsoid();
  const auto means = means_of(summarize_columns(planted(graph, 6, 100, 0.5, 33)));
  const SurfaceTest test = test_replicates(means, 3, graph, {});
  const PlaceTests places = test_places(test, means, 3, graph, {{0, 5, 7}, {}}, 0.95);
  std::vector<double> values;
  for (const auto& m : means)
    values.push_back((graph.area[0] * m[0] + graph.area[5] * m[5] + graph.area[7] * m[7]) /
                     (graph.area[0] + graph.area[5] + graph.area[7]));
  const WelchTest direct = welch_test(group_moments(values.data(), 3), group_moments(values.data() + 3, 3));
  CHECK(places.t[0] == doctest::Approx(direct.t));
  CHECK(places.p[0] == doctest::Approx(direct.p));
  CHECK(std::isnan(places.p[1]));
}

TEST_CASE("several surfaces together: p are shares of the largest value on any, and false alarms stay nominal") {
  const MeshGraph graph = ellipsoid();
  constexpr std::size_t kDraws = 200, kSurfaces = 3;
  std::size_t n_together = 0, n_alone = 0;
  for (std::size_t draw = 0; draw < kDraws; ++draw) {
    std::vector<SurfaceTest> tests;
    for (std::size_t s = 0; s < kSurfaces; ++s) {
      const auto means = means_of(summarize_columns(planted(graph, 8, 10, 0, 1000 + kSurfaces * draw + s)));
      tests.push_back(test_replicates(means, 4, graph, {}));
    }
    const auto has_alarm = [](const SurfaceTest& t) {
      return *std::min_element(t.p_tfce.begin(), t.p_tfce.end()) <= 0.05;
    };
    n_alone += std::any_of(tests.begin(), tests.end(), has_alarm) ? 1 : 0;
    const std::vector<SurfaceTest> alone = tests;
    control_together({&tests[0], &tests[1], &tests[2]});
    n_together += std::any_of(tests.begin(), tests.end(), has_alarm) ? 1 : 0;
    if (draw > 0) continue;
    for (std::size_t v = 0; v < graph.n_vertices(); v += 7) {
      double n = 0;
      for (std::size_t k = 0; k < alone[0].n_permutations; ++k) {
        double largest = 0;
        for (const SurfaceTest& t : alone) largest = std::max(largest, t.maxima.t[k]);
        n += largest >= std::fabs(alone[1].vertices.t[v]) * (1 - 1e-9) ? 1 : 0;
      }
      CHECK(tests[1].p_max_t[v] == doctest::Approx(n / 70));
      CHECK(tests[1].p_max_t[v] >= alone[1].p_max_t[v]);
      CHECK(tests[1].p_tfce[v] >= alone[1].p_tfce[v]);
    }
    SurfaceTest single = alone[0];
    control_together({&single});
    CHECK(single.p_tfce == alone[0].p_tfce);
  }
  MESSAGE("false alarms of " << kDraws << ": " << n_together << " together, " << n_alone << " each surface alone");
  CHECK(n_together <= 13);  // 5.7 expected; more in one of a thousand
  CHECK(n_together >= 1);
  CHECK(n_alone > 2 * n_together - 4);
}

TEST_CASE("one replicate a group: exchanged blocks find the patch") {
  const MeshGraph graph = ellipsoid();
  const ColumnsInMemory columns = planted(graph, 2, 800, 1.0, 34);
  const auto replicates = summarize_columns(columns);
  const std::vector<char> tested(graph.n_vertices(), 1);
  const SurfaceTest test = test_within_runs(columns, replicates, 1, tested, graph, {});
  CHECK(test.inference == Inference::kWithinRuns);
  CHECK(test.no_p.empty());
  CHECK(test.blocks.n == std::vector<std::size_t>{7, 7});
  CHECK(test.n_permutations == 3432);
  CHECK(test.exact);
  CHECK(test.p_tfce[0] == doctest::Approx(2.0 / 3432));
  CHECK(test.p_max_t[3] > 0.05);
  // Two means of 800 frames with g = 3, of which the gaps are left out.
  double sum = 0;
  for (const double error : test.vertices.error) sum += error;
  CHECK(sum / static_cast<double>(graph.n_vertices()) == doctest::Approx(std::sqrt(2 * 3.0 / 800)).epsilon(0.1));
  const auto means = means_of(replicates);
  const PlaceTests places = test_places(test, means, 1, graph, {{0}, {}}, 0.95);
  CHECK(test.vertices.difference[0] == doctest::Approx(means[1][0] - means[0][0]));
  CHECK(places.difference[0] == doctest::Approx(test.vertices.difference[0]));
  CHECK(places.error[0] == doctest::Approx(test.vertices.error[0]));
  CHECK(places.p[0] == doctest::Approx(test.vertices.p[0]));
  CHECK(0.5 * (places.low[0] + places.high[0]) == doctest::Approx(places.difference[0]));
  CHECK(std::isnan(places.p[1]));
}

TEST_CASE("runs of different lengths are exchanged in blocks of one length") {
  const MeshGraph graph = ellipsoid();
  ColumnsInMemory columns(graph.n_vertices());
  for (const std::size_t n_frames : {100, 250, 100}) {
    std::vector<float> values(n_frames * graph.n_vertices());
    Normal normal(35, n_frames + columns.n_replicates());
    for (float& value : values) value = static_cast<float>(normal.next());
    columns.add_replicate(std::move(values));
  }
  const auto replicates = summarize_columns(columns);
  SurfaceTestOptions options;
  options.max_permutations = 500;
  const SurfaceTest test =
      test_within_runs(columns, replicates, 1, std::vector<char>(graph.n_vertices(), 1), graph, options);
  CHECK(test.blocks.n[0] == 7);
  CHECK(test.blocks.n[2] == 7);
  CHECK(test.blocks.n[1] >= 16);
  CHECK(test.block_means.size() == test.blocks.n[0] + test.blocks.n[1] + test.blocks.n[2]);
  CHECK(test.n_first_blocks == 7);
  CHECK_FALSE(test.exact);
}

TEST_CASE("one replicate a group: without four blocks there is no p, and the reason is said") {
  const MeshGraph graph = ellipsoid();
  const ColumnsInMemory columns = planted(graph, 2, 20, 1.0, 36);
  const auto replicates = summarize_columns(columns);
  const SurfaceTest test =
      test_within_runs(columns, replicates, 1, std::vector<char>(graph.n_vertices(), 1), graph, {});
  CHECK(test.no_p.find(" frames hold as much information as one (ninth decile over the surface), so that a run has ") !=
        std::string::npos);
  CHECK(test.no_p.find(" that can be exchanged; 4 are needed, which takes " + std::to_string(test.blocks.least_frames) +
                       " frames of each run, or two replicates") != std::string::npos);
  CHECK(std::isnan(test.p_tfce[0]));
  CHECK(std::isnan(test.vertices.p[0]));
  CHECK(std::isfinite(test.vertices.difference[0]));
  const PlaceTests places = test_places(test, means_of(replicates), 1, graph, {{0, 3}}, 0.95);
  CHECK(std::isfinite(places.difference[0]));
  CHECK(std::isnan(places.p[0]));
  CHECK(std::isnan(places.low[0]));
}

TEST_CASE("one replicate a group: without an effect there are no more false alarms than alpha") {
  // 200 nulls of 25 independent frames, smooth over the surface; bench/within_run_rates.cpp has other lengths and
  // correlations. Binomial: 5 % of 200 are 10 +- 3.1; three standard deviations.
  const MeshGraph graph = ellipsoid();
  int with_p = 0, by_max_t = 0, by_tfce = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    ColumnsInMemory columns(graph.n_vertices());
    Normal normal(37, k);
    for (int run = 0; run < 2; ++run) {
      std::vector<float> values;
      for (std::size_t f = 0; f < 25; ++f) {
        std::vector<double> rough(graph.n_vertices());
        for (double& value : rough) value = normal.next();
        for (std::size_t v = 0; v < rough.size(); ++v) {
          double sum = rough[v];
          for (std::uint32_t n = graph.first[v]; n < graph.first[v + 1]; ++n) sum += rough[graph.neighbours[n]];
          values.push_back(static_cast<float>(sum));
        }
      }
      columns.add_replicate(std::move(values));
    }
    const SurfaceTest test =
        test_within_runs(columns, summarize_columns(columns), 1, std::vector<char>(graph.n_vertices(), 1), graph, {});
    const auto is_found = [](const std::vector<double>& p) {
      return std::any_of(p.begin(), p.end(), [](double value) { return value <= 0.05; });
    };
    with_p += test.no_p.empty() ? 1 : 0;
    by_max_t += is_found(test.p_max_t) ? 1 : 0;
    by_tfce += is_found(test.p_tfce) ? 1 : 0;
  }
  MESSAGE("with p: ", with_p, " of 200; significant: ", by_max_t, " by max-t, ", by_tfce, " by TFCE");
  CHECK(with_p >= 150);
  CHECK(by_max_t <= 19);
  CHECK(by_tfce <= 19);
}

TEST_CASE("columns that are read in parts give the same bits as at once") {
  const MeshGraph graph = ellipsoid();
  class Narrow : public Columns {  // reports so many frames that few columns are read at a time
   public:
    explicit Narrow(const Columns& all) : all_(all) {}
    std::size_t n_columns() const override { return all_.n_columns(); }
    std::size_t n_replicates() const override { return 1; }
    std::size_t n_frames(std::size_t r) const override { return all_.n_frames(r); }
    void read(std::size_t r, std::size_t begin, std::size_t end, std::vector<float>& values) const override {
      ++n_reads;
      all_.read(r, begin, end, values);
    }
    mutable int n_reads = 0;

   private:
    const Columns& all_;
  };
  const ColumnsInMemory columns = planted(graph, 1, 100000, 0, 35);
  const Narrow narrow(columns);
  const auto summary = summarize_columns(narrow);
  CHECK(narrow.n_reads > 1);
  std::vector<float> values;
  columns.read(0, 161, 162, values);
  CHECK(summary[0].columns[161].mean == summarize_series(std::vector<double>(values.begin(), values.end())).mean);
}

TEST_SUITE_END();
