// mesh_graph.cpp: collects edges and areas from triangles.
#include "statistics/surface/mesh_graph.h"

#include <algorithm>
#include <utility>

#include "base/triangle_areas.h"

namespace espdiff {

MeshGraph make_mesh_graph(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
  MeshGraph graph;
  graph.area.assign(positions.size(), 0);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : triangles) {
    const double area = triangle_area(positions, t);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = t[corner], b = t[(corner + 1) % 3];
      graph.area[a] += area / 3;
      edges.emplace_back(a, b);
      edges.emplace_back(b, a);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  graph.first.assign(positions.size() + 1, 0);
  for (const auto& [a, b] : edges) {
    ++graph.first[a + 1];
    graph.neighbours.push_back(b);
  }
  for (std::size_t v = 0; v < positions.size(); ++v) graph.first[v + 1] += graph.first[v];
  return graph;
}

}  // namespace espdiff
