// patches.cpp: flood fill over the mesh.
#include "statistics/surface/patches.h"

#include <algorithm>
#include <cmath>

#include "statistics/surface/mesh_graph.h"

namespace espdiff {

std::vector<SignificantPatch> find_patches(const std::vector<double>& p, const std::vector<double>& values,
                                           double alpha, const MeshGraph& graph) {
  std::vector<char> open(p.size());
  for (std::size_t v = 0; v < p.size(); ++v) open[v] = p[v] <= alpha && values[v] != 0 ? 1 : 0;
  std::vector<SignificantPatch> patches;
  for (std::uint32_t start = 0; start < p.size(); ++start) {
    if (open[start] == 0) continue;
    SignificantPatch patch;
    patch.vertices.push_back(start);
    open[start] = 0;
    for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
      const std::uint32_t v = patch.vertices[i];
      for (std::uint32_t n = graph.first[v]; n < graph.first[v + 1]; ++n) {
        const std::uint32_t w = graph.neighbours[n];
        if (open[w] == 0 || (values[w] > 0) != (values[start] > 0)) continue;
        open[w] = 0;
        patch.vertices.push_back(w);
      }
    }
    std::sort(patch.vertices.begin(), patch.vertices.end());
    patch.peak = start;
    for (const std::uint32_t v : patch.vertices) {
      patch.area += graph.area[v];
      if (std::fabs(values[v]) > std::fabs(values[patch.peak])) patch.peak = v;
    }
    patches.push_back(std::move(patch));
  }
  std::stable_sort(patches.begin(), patches.end(), [](const auto& a, const auto& b) { return a.area > b.area; });
  return patches;
}

}  // namespace espdiff
