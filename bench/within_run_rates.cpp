// within_run_rates.cpp: false alarms and power of the test of one run against another, by frames and correlation.
//
//     espdiff_within_run_rates 200            # without an effect, 200 repeats of each row, as a table
//     espdiff_within_run_rates 200 1.5        # the second run differs by 1.5 standard deviations on 5 % of the area
//     espdiff_within_run_rates 200 0 0.2      # only a fifth of the surface is correlated in time, the rest is not
//     espdiff_within_run_rates 400 0 1 100 2  # one row: 100 frames, g = 2
//
// Fields are noise on an ellipsoid of 642 vertices, smooth over the surface and autoregressive in time.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "statistics/columns.h"
#include "statistics/planted_columns.h"
#include "statistics/replicate_columns.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/surface_test.h"
#include "statistics/test_within_runs.h"

using namespace espdiff;
using espdiff_test::Normal;

namespace {

/// Twice the average of each vertex and its neighbours.
void smooth(std::vector<double>& field, const MeshGraph& graph) {
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<double> rough = field;
    for (std::size_t v = 0; v < field.size(); ++v) {
      for (std::uint32_t n = graph.first[v]; n < graph.first[v + 1]; ++n) field[v] += rough[graph.neighbours[n]];
      field[v] /= 1 + graph.first[v + 1] - graph.first[v];
    }
  }
}

/// Kinds of noise, and what differs.
struct Design {
  double inefficiency = 1, correlated_share = 1, effect = 0;
};

/// A run, [frame][vertex]. Smoothing leaves about a quarter of the deviation, to which the effect is scaled.
std::vector<float> make_run(const MeshGraph& graph, std::size_t n_frames, const Design& design, bool second,
                            Normal& normal) {
  const std::size_t n = graph.n_vertices();
  const double phi = (design.inefficiency - 1) / (design.inefficiency + 1);
  const auto n_correlated = static_cast<std::size_t>(design.correlated_share * static_cast<double>(n));
  std::vector<double> field(n);
  std::vector<float> values;
  for (std::size_t f = 0; f < n_frames; ++f) {
    std::vector<double> fresh(n);
    for (double& x : fresh) x = normal.next();
    smooth(fresh, graph);
    for (std::size_t v = 0; v < n; ++v) {
      const double memory = v < n_correlated && f > 0 ? phi : 0;
      field[v] = memory * field[v] + std::sqrt(1 - memory * memory) * fresh[v];
      values.push_back(static_cast<float>(field[v] + (second && v < n / 20 ? 0.25 * design.effect : 0)));
    }
  }
  return values;
}

bool has_significant(const std::vector<double>& p) {
  return std::any_of(p.begin(), p.end(), [](double value) { return value <= 0.05; });
}

void print_row(const MeshGraph& graph, std::size_t n_frames, const Design& design, int repeats) {
  int with_p = 0, max_t = 0, tfce = 0;
  double blocks = 0;
  for (int k = 0; k < repeats; ++k) {
    Normal normal(97 + n_frames, static_cast<std::uint64_t>(1000 * design.inefficiency) * 100000 + k);
    ColumnsInMemory columns(graph.n_vertices());
    columns.add_replicate(make_run(graph, n_frames, design, false, normal));
    columns.add_replicate(make_run(graph, n_frames, design, true, normal));
    const SurfaceTest test =
        test_within_runs(columns, summarize_columns(columns), 1, std::vector<char>(graph.n_vertices(), 1), graph, {});
    blocks += static_cast<double>(test.blocks.n.front()) / repeats;
    with_p += test.no_p.empty() ? 1 : 0;
    max_t += has_significant(test.p_max_t) ? 1 : 0;
    tfce += has_significant(test.p_tfce) ? 1 : 0;
  }
  std::printf("| %zu | %g | %.1f | %d | %d | %d | %d |\n", n_frames, design.inefficiency, blocks, repeats, with_p,
              max_t, tfce);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc == 5 || argc > 6) {
    std::fprintf(stderr, "usage: espdiff_within_run_rates REPEATS [EFFECT [CORRELATED_SHARE [FRAMES G]]]\n");
    return 2;
  }
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  espdiff_test::make_ellipsoid(3, positions, triangles);
  const MeshGraph graph = make_mesh_graph(positions, triangles);
  Design design;
  design.effect = argc > 2 ? std::strtod(argv[2], nullptr) : 0;
  design.correlated_share = argc > 3 ? std::strtod(argv[3], nullptr) : 1;
  std::printf(
      "| frames | g | blocks | repeats | with p | significant by max-t | by TFCE |\n|---|---|---|---|---|---|---|\n");
  const bool is_one_row = argc == 6;
  const auto frames = is_one_row ? std::vector<std::size_t>{std::strtoul(argv[4], nullptr, 10)}
                                 : std::vector<std::size_t>{10, 20, 25, 50, 100};
  const auto inefficiencies =
      is_one_row ? std::vector<double>{std::strtod(argv[5], nullptr)} : std::vector<double>{1, 2, 5, 10, 20};
  for (const std::size_t n_frames : frames) {
    for (const double g : inefficiencies) {
      design.inefficiency = g;
      print_row(graph, n_frames, design, static_cast<int>(std::strtol(argv[1], nullptr, 10)));
    }
  }
  return 0;
}
