// planted.cpp: false alarms over repeats without an effect. bench/ensemble_rates does 1,000 with real meshes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "statistics/planted_columns.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/surface_test.h"
#include "statistics/test_replicates.h"

using namespace espdiff;
using espdiff_test::make_ellipsoid;
using espdiff_test::Normal;

namespace {

/// The distance of Kolmogorov and Smirnov from p-values to the uniform distribution on (0, 1].
double distance_to_uniform(std::vector<double> p) {
  std::sort(p.begin(), p.end());
  double distance = 0;
  const double n = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i)
    distance = std::max(
        {distance, std::fabs(p[i] - static_cast<double>(i) / n), std::fabs(p[i] - static_cast<double>(i + 1) / n)});
  return distance;
}

/// What repeats without an effect give: counts of p <= 0.05 somewhere on the surface, and p.
struct Repeats {
  int by_max_t = 0, by_tfce = 0;
  std::vector<double> single, whole;  ///< of one vertex, and the smallest family-wise one by max-t
};

/// Smooth noise on an ellipsoid, so many replicates against as many.
Repeats repeat(std::size_t n_replicates, int n_repeats) {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  make_ellipsoid(2, positions, triangles);
  const MeshGraph graph = make_mesh_graph(positions, triangles);
  Repeats repeats;
  for (int k = 0; k < n_repeats; ++k) {
    Normal normal(41, static_cast<std::uint64_t>(k));
    std::vector<std::vector<double>> means(2 * n_replicates, std::vector<double>(graph.n_vertices()));
    for (auto& replicate : means) {
      for (double& value : replicate) value = normal.next();
      const std::vector<double> rough = replicate;  // neighbouring vertices are alike
      for (std::uint32_t v = 0; v < rough.size(); ++v) {
        for (std::uint32_t n = graph.first[v]; n < graph.first[v + 1]; ++n) replicate[v] += rough[graph.neighbours[n]];
      }
    }
    const SurfaceTest test = test_replicates(means, n_replicates, graph, {});
    repeats.by_max_t += *std::min_element(test.p_max_t.begin(), test.p_max_t.end()) <= 0.05 ? 1 : 0;
    repeats.by_tfce += *std::min_element(test.p_tfce.begin(), test.p_tfce.end()) <= 0.05 ? 1 : 0;
    repeats.single.push_back(test.vertices.p[static_cast<std::size_t>(k) % graph.n_vertices()]);
    repeats.whole.push_back(*std::min_element(test.p_max_t.begin(), test.p_max_t.end()));
  }
  return repeats;
}

}  // namespace

TEST_SUITE_BEGIN("planted");

TEST_CASE("without an effect, the surface has false alarms at the rate of alpha") {
  constexpr int kRepeats = 1000;
  const Repeats found = repeat(4, kRepeats);
  // 4 against 4 has p in steps of 2/70, and p <= 0.05 means 2/70 = 2.9 %; three standard deviations are 1.6 %.
  MESSAGE("false alarms: max-t ", found.by_max_t, ", TFCE ", found.by_tfce, " of ", kRepeats, "; expected 29");
  CHECK(std::abs(found.by_max_t - 29) <= 16);
  CHECK(std::abs(found.by_tfce - 29) <= 16);
  // Kolmogorov and Smirnov at 1 %: 1.63 / sqrt(n). Family-wise p moves in steps of 2/70.
  MESSAGE("distance to uniform: Welch's p ", distance_to_uniform(found.single), ", family-wise ",
          distance_to_uniform(found.whole));
  CHECK(distance_to_uniform(found.whole) < 2.0 / 70 + 1.63 / std::sqrt(static_cast<double>(kRepeats)));
  // Welch's test with 4 against 4 is slightly conservative.
  CHECK(distance_to_uniform(found.single) < 0.02 + 1.63 / std::sqrt(static_cast<double>(kRepeats)));
}

TEST_CASE("with more replicates the rate comes near 5 %") {
  // 5 against 5 has p in steps of 2/252, and p <= 0.05 means 12/252 = 4.8 %; three standard deviations are 3.2 %.
  constexpr int kRepeats = 400;
  const Repeats found = repeat(5, kRepeats);
  MESSAGE("false alarms, 5 against 5: max-t ", found.by_max_t, ", TFCE ", found.by_tfce, " of ", kRepeats,
          "; expected 19");
  CHECK(std::abs(found.by_max_t - 19) <= 13);
  CHECK(std::abs(found.by_tfce - 19) <= 13);
}

TEST_SUITE_END();
