// test_places.cpp: area-weighted means over sets of vertices, compared between groups.
#include <cmath>
#include <limits>

#include "statistics/mesh_graph.h"
#include "statistics/null_maxima.h"
#include "statistics/surface_test.h"
#include "statistics/welch.h"

namespace espdiff {

PlaceTests test_places(const SurfaceTest& surface, const std::vector<std::vector<double>>& means, std::size_t n_first,
                       const MeshGraph& graph, const std::vector<std::vector<std::uint32_t>>& members,
                       double confidence) {
  if (surface.inference == Inference::kWithinRuns) return test_places_by_bootstrap(surface, graph, members, confidence);
  PlaceTests tests;
  for (const auto& vertices : members) {
    double area = 0;
    std::vector<double> values(means.size(), 0);
    for (const std::uint32_t v : vertices) {
      if (!std::isfinite(surface.vertices.t[v])) continue;
      area += graph.area[v];
      for (std::size_t r = 0; r < means.size(); ++r) values[r] += graph.area[v] * means[r][v];
    }
    for (double& value : values) value = area > 0 ? value / area : std::numeric_limits<double>::quiet_NaN();
    add_place(tests,
              welch_test(group_moments(values.data(), n_first),
                         group_moments(values.data() + n_first, values.size() - n_first)),
              confidence);
  }
  return tests;
}

}  // namespace espdiff
