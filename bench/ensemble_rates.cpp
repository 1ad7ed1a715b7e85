// ensemble_rates.cpp: false alarms and power of the surface tests on the template of a real ensemble.
//
//     espdiff_ensemble_rates OUT.h5 1000 0      # without an effect
//     espdiff_ensemble_rates OUT.h5 200 2       # with one of 2 standard deviations of a replicate's mean, on 5 % of
//     the area
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "ensemble/ensemble_file.h"
#include "statistics/counter_random.h"
#include "statistics/mesh_graph.h"
#include "statistics/surface_test.h"

using namespace espdiff;

namespace {

double uniform(std::uint64_t stream, std::uint64_t counter) {
  return (static_cast<double>(random_bits(7, stream, counter) >> 11) + 0.5) / 9007199254740992.0;
}

/// Normal noise that neighbours share, of unit variance.
std::vector<double> smooth_noise(const MeshGraph& graph, std::uint64_t stream) {
  std::vector<double> x(graph.n_vertices());
  for (std::size_t v = 0; v < x.size(); ++v)
    x[v] = std::sqrt(-2 * std::log(uniform(stream, 2 * v))) * std::cos(6.283185307179586 * uniform(stream, 2 * v + 1));
  for (int round = 0; round < 8; ++round) {
    const std::vector<double> before = x;
    for (std::size_t v = 0; v < x.size(); ++v) {
      for (std::uint32_t n = graph.first[v]; n < graph.first[v + 1]; ++n) x[v] += before[graph.neighbours[n]];
      x[v] /= static_cast<double>(graph.first[v + 1] - graph.first[v] + 1);
    }
  }
  double squares = 0;
  for (const double value : x) squares += value * value;
  for (double& value : x) value /= std::sqrt(squares / static_cast<double>(x.size()));
  return x;
}

/// The vertices around the first one that have 5 % of the area.
std::vector<char> patch_of(const TemplateSurface& surface, const MeshGraph& graph) {
  std::vector<std::size_t> order(graph.n_vertices());
  for (std::size_t v = 0; v < order.size(); ++v) order[v] = v;
  const auto distance = [&](std::size_t v) { return norm(surface.positions[v] - surface.positions[0]); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  double all = 0, area = 0;
  for (const double a : graph.area) all += a;
  std::vector<char> inside(order.size(), 0);
  for (const std::size_t v : order) {
    if (area > 0.05 * all) break;
    area += graph.area[v];
    inside[v] = 1;
  }
  return inside;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: espdiff_ensemble_rates OUT.h5 REPEATS EFFECT\n");
    return 2;
  }
  const EnsembleFile file(argv[1], false);
  const MeshGraph graph = make_mesh_graph(file.surface().positions, file.surface().triangles);
  const std::vector<char> inside = patch_of(file.surface(), graph);
  const std::uint64_t repeats = std::strtoul(argv[2], nullptr, 10);
  const double effect = std::strtod(argv[3], nullptr);
  int max_t = 0, tfce = 0;
  std::vector<double> p;
  for (std::uint64_t k = 0; k < repeats; ++k) {
    std::vector<std::vector<double>> means;
    for (std::uint64_t r = 0; r < 8; ++r) {
      means.push_back(smooth_noise(graph, 8 * k + r));
      for (std::size_t v = 0; v < inside.size(); ++v) means.back()[v] += r >= 4 && inside[v] != 0 ? effect : 0;
    }
    const SurfaceTest test = test_replicates(means, 4, graph, {});
    max_t += *std::min_element(test.p_max_t.begin(), test.p_max_t.end()) <= 0.05 ? 1 : 0;
    tfce += *std::min_element(test.p_tfce.begin(), test.p_tfce.end()) <= 0.05 ? 1 : 0;
    p.push_back(test.vertices.p[static_cast<std::size_t>(k * 7919) % inside.size()]);
  }
  std::sort(p.begin(), p.end());
  double distance = 0;
  const double n = static_cast<double>(repeats);
  for (std::size_t i = 0; i < p.size(); ++i)
    distance = std::max(
        {distance, std::fabs(p[i] - static_cast<double>(i) / n), std::fabs(p[i] - (static_cast<double>(i) + 1) / n)});
  std::printf(
      "%zu vertices, %llu repeats, effect %g: p <= 0.05 in %.1f %% by max-t, %.1f %% by TFCE (2.9 %% expected without "
      "an effect)\nWelch's p of one vertex: Kolmogorov-Smirnov distance to uniform %.3f (1 %% limit %.3f)\n",
      graph.n_vertices(), static_cast<unsigned long long>(repeats), effect, 100 * max_t / n, 100 * tfce / n, distance,
      1.63 / std::sqrt(n));
  return 0;
}
