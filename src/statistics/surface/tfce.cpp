// tfce.cpp: the integral over thresholds by union-find with sums along the paths.
#include "statistics/surface/tfce.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "statistics/surface/mesh_graph.h"

namespace espdiff {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Pieces above a falling threshold. A vertex's score is the sum of `score` from it to its root.
class Pieces {
 public:
  Pieces(const MeshGraph& graph, const TfceOptions& options)
      : options_(options),
        parent_(graph.n_vertices(), kNone),
        area_(graph.area),
        height_(graph.n_vertices(), 0),
        score_(graph.n_vertices(), 0) {}

  bool has(std::uint32_t v) const { return parent_[v] != kNone; }
  void add(std::uint32_t v, double height) {
    parent_[v] = v;
    height_[v] = height;
  }

  void merge(std::uint32_t a, std::uint32_t b, double height) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    lower(a, height);
    lower(b, height);
    if (area_[a] < area_[b]) std::swap(a, b);
    score_[b] -= score_[a];
    area_[a] += area_[b];
    parent_[b] = a;
  }

  /// @pre the threshold has fallen to 0
  double score(std::uint32_t v) {
    const std::uint32_t r = root(v);
    lower(r, 0);
    return v == r ? score_[v] : score_[v] + score_[r];
  }

 private:
  /// Adds the integral from the height that a piece had to a lower one.
  void lower(std::uint32_t r, double height) {
    const double power = options_.height_power + 1;
    score_[r] +=
        std::pow(area_[r], options_.extent_power) * (std::pow(height_[r], power) - std::pow(height, power)) / power;
    height_[r] = height;
  }

  /// Compresses the path; the sums along it stay.
  std::uint32_t root(std::uint32_t v) {
    path_.clear();
    while (parent_[v] != v) {
      path_.push_back(v);
      v = parent_[v];
    }
    double sum = 0;
    for (auto i = path_.rbegin(); i != path_.rend(); ++i) {
      sum += score_[*i];
      score_[*i] = sum;
      parent_[*i] = v;
    }
    return v;
  }

  TfceOptions options_;
  std::vector<std::uint32_t> parent_, path_;
  std::vector<double> area_, height_, score_;  // area and height of roots
};

/// Scores of one sign.
void enhance(const std::vector<double>& values, double sign, const MeshGraph& graph, const TfceOptions& options,
             std::vector<double>& scores) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < values.size(); ++v) {
    if (sign * values[v] > 0 && std::isfinite(values[v])) order.push_back(v);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::fabs(values[a]) != std::fabs(values[b]) ? std::fabs(values[a]) > std::fabs(values[b]) : a < b;
  });
  Pieces pieces(graph, options);
  for (const std::uint32_t v : order) {
    const double height = std::fabs(values[v]);
    pieces.add(v, height);
    for (std::uint32_t n = graph.first[v]; n < graph.first[v + 1]; ++n) {
      if (pieces.has(graph.neighbours[n])) pieces.merge(v, graph.neighbours[n], height);
    }
  }
  for (const std::uint32_t v : order) scores[v] = sign * pieces.score(v);
}

}  // namespace

std::vector<double> enhance_clusters(const std::vector<double>& values, const MeshGraph& graph,
                                     const TfceOptions& options) {
  std::vector<double> scores(values.size(), 0);
  enhance(values, 1, graph, options, scores);
  enhance(values, -1, graph, options, scores);
  return scores;
}

}  // namespace espdiff
