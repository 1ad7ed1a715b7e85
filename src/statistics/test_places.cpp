// test_places.cpp: area-weighted means over sets of vertices, compared between groups.
#include "statistics/test_places.h"

#include <cmath>
#include <limits>

#include "statistics/null_maxima.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/surface_test.h"
#include "statistics/welch.h"

namespace espdiff {
namespace {

/// [row] area-weighted means over the tested vertices of a place; NaN without one.
std::vector<double> means_over(const std::vector<std::vector<double>>& rows, const std::vector<std::uint32_t>& vertices,
                               const std::vector<double>& tested, const MeshGraph& graph) {
  double area = 0;
  std::vector<double> values(rows.size(), 0);
  for (const std::uint32_t v : vertices) {
    if (!std::isfinite(tested[v])) continue;
    area += graph.area[v];
    for (std::size_t r = 0; r < rows.size(); ++r) values[r] += graph.area[v] * rows[r][v];
  }
  for (double& value : values) value = area > 0 ? value / area : std::numeric_limits<double>::quiet_NaN();
  return values;
}

WelchTest test_split(const std::vector<double>& values, std::size_t n_first) {
  return welch_test(group_moments(values.data(), n_first),
                    group_moments(values.data() + n_first, values.size() - n_first));
}

}  // namespace

PlaceTests test_places(const SurfaceTest& surface, const std::vector<std::vector<double>>& means, std::size_t n_first,
                       const MeshGraph& graph, const std::vector<std::vector<std::uint32_t>>& members,
                       double confidence) {
  PlaceTests tests;
  const bool by_blocks = surface.inference == Inference::kWithinRuns;
  const std::vector<double>& tested = by_blocks ? surface.vertices.difference : surface.vertices.t;
  for (const auto& vertices : members) {
    const WelchTest of_replicates = test_split(means_over(means, vertices, tested, graph), n_first);
    if (!by_blocks) {
      add_place(tests, of_replicates, confidence);
      continue;
    }
    add_place(tests,
              test_split(means_over(surface.block_means, vertices, surface.vertices.t, graph), surface.n_first_blocks),
              confidence);
    move_to(tests, tests.difference.size() - 1, of_replicates.difference);
  }
  return tests;
}

}  // namespace espdiff
