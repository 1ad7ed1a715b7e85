// ensemble_rates.cpp: false alarms and power of the surface tests on a real ensemble, with its own correlations.
//
//     espdiff_ensemble_rates OUT.h5 1000 0      # without an effect
//     espdiff_ensemble_rates OUT.h5 200 2       # with one of 2 standard deviations of a replicate's mean, on 5 % of
//                                               # the area
//     espdiff_ensemble_rates OUT.h5 nulls       # no noise of ours: the simulations against themselves, in all splits
//
// Fields of noise have the covariance of the simulations: random sums of the deviations of block means from their
// replicate's mean, ten blocks a replicate.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "base/counter_random.h"
#include "ensemble/balanced_splits.h"
#include "ensemble/file/ensemble_columns.h"
#include "ensemble/file/ensemble_file.h"
#include "statistics/replicate_columns.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/surface_test.h"
#include "statistics/test_replicates.h"
#include "statistics/test_within_runs.h"

using namespace espdiff;

namespace {

double uniform(std::uint64_t stream, std::uint64_t counter) {
  return (static_cast<double>(random_bits(7, stream, counter) >> 11) + 0.5) / 9007199254740992.0;
}

double normal(std::uint64_t stream, std::uint64_t counter) {
  return std::sqrt(-2 * std::log(uniform(stream, 2 * counter))) *
         std::cos(6.283185307179586 * uniform(stream, 2 * counter + 1));
}

using Fields = std::vector<std::vector<double>>;

/// [block of all replicates][vertex] deviations of block means from their replicate's; 0 where a value is missing.
Fields deviations_of(const std::vector<ReplicateColumns>& replicates, std::size_t n_vertices) {
  Fields fields;
  for (const ReplicateColumns& r : replicates) {
    for (std::size_t block = 0; block < kBlocks; ++block) {
      fields.emplace_back(n_vertices, 0.0);
      for (std::size_t v = 0; v < n_vertices; ++v) {
        const double deviation = r.blocks[v * kBlocks + block] - r.columns[v].mean;
        if (std::isfinite(deviation)) fields.back()[v] = deviation;
      }
    }
  }
  return fields;
}

/// [vertex] of unit variance where the fields have one.
std::vector<double> spread_of(const Fields& fields) {
  std::vector<double> spread(fields.front().size(), 0);
  for (const auto& field : fields) {
    for (std::size_t v = 0; v < spread.size(); ++v) spread[v] += field[v] * field[v];
  }
  for (double& s : spread) s = std::sqrt(s);
  return spread;
}

/// A normal field with the fields' covariance.
std::vector<double> real_noise(const Fields& fields, std::uint64_t stream) {
  std::vector<double> x(fields.front().size(), 0);
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const double weight = normal(stream, k);
    for (std::size_t v = 0; v < x.size(); ++v) x[v] += weight * fields[k][v];
  }
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

double smallest(const std::vector<double>& p) {
  double least = 1;
  for (const double value : p) least = std::isfinite(value) ? std::min(least, value) : least;
  return least;
}

/// Columns of some replicates of others.
class SomeReplicates : public Columns {
 public:
  SomeReplicates(const Columns& all, std::vector<std::size_t> chosen) : all_(all), chosen_(std::move(chosen)) {}
  std::size_t n_columns() const override { return all_.n_columns(); }
  std::size_t n_replicates() const override { return chosen_.size(); }
  std::size_t n_frames(std::size_t replicate) const override { return all_.n_frames(chosen_[replicate]); }
  void read(std::size_t replicate, std::size_t begin, std::size_t end, std::vector<float>& values) const override {
    all_.read(chosen_[replicate], begin, end, values);
  }

 private:
  const Columns& all_;
  std::vector<std::size_t> chosen_;
};

/// Significant by max-t, and by TFCE, among so many.
struct Count {
  int n = 0, max_t = 0, tfce = 0;
  void add(const SurfaceTest& test) {
    ++n;
    max_t += smallest(test.p_max_t) <= 0.05 ? 1 : 0;
    tfce += smallest(test.p_tfce) <= 0.05 ? 1 : 0;
  }
  void print(const char* what) const {
    std::printf("%-62s %3d of %3d by max-t, %3d of %3d by TFCE\n", what, max_t, n, tfce, n);
  }
};

/// Simulations of one state against each other: whatever is significant is a false alarm, or runs that are too short.
void print_nulls(const EnsembleFile& file, const Columns& columns, const std::vector<ReplicateColumns>& replicates,
                 const MeshGraph& graph) {
  const auto first = file.plan().replicates_of(file.plan().groups().at(0)),
             second = file.plan().replicates_of(file.plan().groups().at(1));
  const std::size_t n = graph.n_vertices();
  std::vector<std::vector<double>> means(replicates.size()), halves;
  for (std::size_t r = 0; r < replicates.size(); ++r) {
    for (std::size_t v = 0; v < n; ++v) means[r].push_back(replicates[r].columns[v].mean);
  }
  Count balanced;
  for (const auto& [one, two] : espdiff_test::balanced_splits(first, second)) {
    std::vector<std::vector<double>> some;
    for (const auto* group : {&one, &two}) {
      for (const std::size_t r : *group) some.push_back(means[r]);
    }
    balanced.add(test_replicates(some, one.size(), graph, {}));
  }
  balanced.print("half of each state's runs against the other half of each");
  for (const auto* group : {&first, &second}) {
    halves.clear();
    for (const std::size_t r : *group) halves.push_back(replicates[r].first_half);
    for (const std::size_t r : *group) halves.push_back(replicates[r].second_half);
    Count count;
    count.add(test_replicates(halves, group->size(), graph, {}));
    count.print("first halves of a state's runs against the second halves");
  }
  Count runs;
  const std::vector<char> tested(n, 1);
  for (const auto* group : {&first, &second}) {
    for (std::size_t i = 0; i < group->size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const SomeReplicates pair(columns, {(*group)[i], (*group)[j]});
        runs.add(test_within_runs(pair, {replicates[(*group)[i]], replicates[(*group)[j]]}, 1, tested, graph, {}));
      }
    }
  }
  runs.print("a run against another one of the same state, by blocks");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4 && !(argc == 3 && std::string(argv[2]) == "nulls")) {
    std::fprintf(stderr, "usage: espdiff_ensemble_rates OUT.h5 REPEATS EFFECT, or OUT.h5 nulls\n");
    return 2;
  }
  const EnsembleFile file(argv[1], false);
  const MeshGraph graph = make_mesh_graph(file.surface().positions, file.surface().triangles);
  const EnsembleColumns columns(file, std::vector<std::size_t>(file.plan().replicates.size(), 0));
  const std::vector<ReplicateColumns> replicates = summarize_columns(columns);
  if (argc == 3) {
    print_nulls(file, columns, replicates, graph);
    return 0;
  }
  const Fields fields = deviations_of(replicates, graph.n_vertices());
  const std::vector<double> spread = spread_of(fields);
  const std::vector<char> inside = patch_of(file.surface(), graph);
  const std::uint64_t repeats = std::strtoul(argv[2], nullptr, 10);
  const double effect = std::strtod(argv[3], nullptr);
  int max_t = 0, tfce = 0;
  std::vector<double> p;
  for (std::uint64_t k = 0; k < repeats; ++k) {
    std::vector<std::vector<double>> means;
    for (std::uint64_t r = 0; r < 8; ++r) {
      means.push_back(real_noise(fields, 8 * k + r));
      for (std::size_t v = 0; v < inside.size(); ++v)
        means.back()[v] += r >= 4 && inside[v] != 0 ? effect * spread[v] : 0;
    }
    const SurfaceTest test = test_replicates(means, 4, graph, {});
    max_t += smallest(test.p_max_t) <= 0.05 ? 1 : 0;
    tfce += smallest(test.p_tfce) <= 0.05 ? 1 : 0;
    const double single = test.vertices.p[static_cast<std::size_t>(k * 7919) % inside.size()];
    if (std::isfinite(single)) p.push_back(single);
  }
  std::sort(p.begin(), p.end());
  double distance = 0;
  const double n = static_cast<double>(repeats), n_single = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i)
    distance = std::max({distance, std::fabs(p[i] - static_cast<double>(i) / n_single),
                         std::fabs(p[i] - (static_cast<double>(i) + 1) / n_single)});
  // Counts of independent repeats: the standard deviation of a share is sqrt(q (1 - q) / n).
  const double expected = 2.0 / 70;
  std::printf(
      "%zu vertices, noise of %zu block means, %llu repeats, effect %g: p <= 0.05 in %.1f %% by max-t, %.1f %% by TFCE "
      "(%.1f +- %.1f %% expected without an effect)\nWelch's p of one vertex: Kolmogorov-Smirnov distance to uniform "
      "%.3f (1 %% limit %.3f)\n",
      graph.n_vertices(), fields.size(), static_cast<unsigned long long>(repeats), effect, 100 * max_t / n,
      100 * tfce / n, 100 * expected, 100 * std::sqrt(expected * (1 - expected) / n), distance,
      1.63 / std::sqrt(n_single));
  return 0;
}
