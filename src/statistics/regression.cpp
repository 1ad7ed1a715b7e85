// regression.cpp: correlations over a surface under all orders of the values, and predictions from the other
// replicates.
#include "statistics/regression.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/counter_random.h"
#include "base/error.h"
#include "base/not_a_number.h"
#include "base/progress.h"
#include "statistics/null_maxima.h"
#include "statistics/surface/mesh_graph.h"
#include "statistics/surface/tfce.h"
#include "statistics/welch.h"

namespace espdiff {
namespace {

using StateOrder = std::vector<std::size_t>;

/// The observed order first.
struct Orders {
  std::vector<StateOrder> all;
  bool exact = true;
};

Orders make_orders(std::size_t n, std::uint64_t most, std::uint64_t seed) {
  Orders orders;
  StateOrder order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  double possible = 1;
  for (std::size_t i = 2; i <= n; ++i) possible *= static_cast<double>(i);
  orders.exact = possible <= static_cast<double>(most);
  if (orders.exact) {
    do orders.all.push_back(order);
    while (std::next_permutation(order.begin(), order.end()));
    return orders;
  }
  orders.all.push_back(order);
  for (std::uint64_t k = 1; k < most; ++k) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = n - 1; i > 0; --i) std::swap(order[i], order[random_below(i + 1, seed, k, i)]);
    orders.all.push_back(order);
  }
  return orders;
}

/// Deviations from the mean.
std::vector<double> centred(std::vector<double> values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  return values;
}

double squares_of(const std::vector<double>& values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

/// The replicates that count: deviations of their columns, and products over the surface.
class Regressed {
 public:
  Regressed(const std::vector<std::vector<double>>& means, const std::vector<double>& values, const MeshGraph& graph)
      : graph_(graph) {
    for (std::size_t r = 0; r < values.size(); ++r) {
      if (!std::isfinite(values[r])) continue;
      counted_.push_back(r);
      values_.push_back(values[r]);
    }
    const std::size_t n = counted_.size();
    products_.assign(n * n, 0);
    columns_.assign(graph.n_vertices(), {});
    for (std::size_t v = 0; v < columns_.size(); ++v) {
      std::vector<double> column;
      for (const std::size_t r : counted_) column.push_back(means[r][v]);
      if (std::any_of(column.begin(), column.end(), [](double x) { return !std::isfinite(x); })) continue;
      columns_[v] = centred(column);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) products_[i * n + j] += graph.area[v] * columns_[v][i] * columns_[v][j];
      }
    }
  }

  const std::vector<std::size_t>& counted() const { return counted_; }
  const std::vector<double>& values() const { return values_; }

  /// Correlations of the values in some order; NaN where a column is missing or does not vary.
  std::vector<double> correlations(const StateOrder& order) const {
    std::vector<double> y;
    for (const std::size_t i : order) y.push_back(values_[i]);
    y = centred(y);
    const double squares = squares_of(y);
    std::vector<double> r(columns_.size(), kNaN);
    for (std::size_t v = 0; v < r.size(); ++v) {
      const std::vector<double>& x = columns_[v];
      const double own = squares_of(x);
      if (own > 0) r[v] = std::inner_product(x.begin(), x.end(), y.begin(), 0.0) / std::sqrt(own * squares);
    }
    return r;
  }

  std::vector<double> t_of(const std::vector<double>& r) const {
    const double degrees = static_cast<double>(counted_.size()) - 2;
    std::vector<double> t;
    t.reserve(r.size());
    for (const double c : r) t.push_back(c * std::sqrt(degrees / std::max(1e-300, 1 - c * c)));
    return t;
  }

  /// The value of replicate `left` from the others, in an order of the values.
  double predict(const StateOrder& order, std::size_t left) const {
    const std::size_t n = values_.size();
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < n; ++i) {
      if (i != left) others.push_back(i);
    }
    const double m = static_cast<double>(n - 1);
    double mean = 0;
    std::vector<double> row(n, 0);  // mean of the others' products with each
    for (const std::size_t i : others) {
      mean += values_[order[i]] / m;
      for (std::size_t j = 0; j < n; ++j) row[j] += products_[i * n + j] / m;
    }
    double all = 0;
    for (const std::size_t i : others) all += row[i] / m;
    // Scores: products of the centred columns with their sum weighted by the centred values.
    const auto score = [&](std::size_t i) {
      double sum = 0;
      for (const std::size_t j : others)
        sum += (products_[i * n + j] - row[i] - row[j] + all) * (values_[order[j]] - mean);
      return sum;
    };
    double product = 0, squares = 0;
    for (const std::size_t i : others) {
      const double s = score(i);
      product += s * (values_[order[i]] - mean);
      squares += s * s;
    }
    return squares > 0 ? mean + product / squares * score(left) : mean;
  }

  double q2(const StateOrder& order) const {
    const std::size_t n = values_.size();
    double sum = 0, error = 0, by_mean = 0;
    for (const double value : values_) sum += value;
    for (std::size_t i = 0; i < n; ++i) {
      const double value = values_[order[i]], mean = (sum - value) / static_cast<double>(n - 1);
      const double miss = value - predict(order, i);
      error += miss * miss;
      by_mean += (value - mean) * (value - mean);
    }
    return 1 - error / by_mean;
  }

  /// Change of the column per unit of the value.
  double slope(std::size_t v, double r) const {
    return r * std::sqrt(squares_of(columns_[v]) / squares_of(centred(values_)));
  }

 private:
  const MeshGraph& graph_;
  std::vector<std::size_t> counted_;
  std::vector<double> values_;
  std::vector<std::vector<double>> columns_;  // [vertex][counted] deviations; empty where not tested
  std::vector<double> products_;              // [counted][counted]
};

void check_values(const std::vector<double>& values) {
  if (values.size() < kFewestValues)
    throw InputError("a regression needs the values of " + std::to_string(kFewestValues) +
                     " replicates or more, and there are " + std::to_string(values.size()));
  if (std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); }))
    throw InputError("a regression needs values that differ; all " + std::to_string(values.size()) + " are equal");
}

}  // namespace

SurfaceRegression regress_on_surface(const std::vector<std::vector<double>>& means, const std::vector<double>& values,
                                     const MeshGraph& graph, const SurfaceTestOptions& options) {
  const Regressed data(means, values, graph);
  check_values(data.values());
  const Orders orders = make_orders(data.values().size(), options.max_permutations, options.seed);
  SurfaceRegression result;
  result.n_permutations = orders.all.size();
  result.exact = orders.exact;
  result.correlation = data.correlations(orders.all.front());
  result.t = data.t_of(result.correlation);
  result.tfce = enhance_clusters(result.t, graph);
  for (std::size_t v = 0; v < result.t.size(); ++v) {
    result.slope.push_back(std::isfinite(result.t[v]) ? data.slope(v, result.correlation[v]) : kNaN);
    result.p.push_back(student_p(result.t[v], static_cast<double>(data.values().size()) - 2));
  }
  result.maxima = {std::vector<double>(orders.all.size()), std::vector<double>(orders.all.size())};
  std::vector<double> q2(orders.all.size());
  const CancelRequest cancel;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t k = 0; k < orders.all.size(); ++k) {
    if (cancel.made()) continue;
    const std::vector<double> t = data.t_of(data.correlations(orders.all[k]));
    result.maxima.t[k] = largest_magnitude(t);
    result.maxima.tfce[k] = largest_magnitude(enhance_clusters(t, graph));
    q2[k] = data.q2(orders.all[k]);
  }
  cancel.check();
  result.p_max_t = shares_at_least(result.maxima.t, result.t, result.t);
  result.p_tfce = shares_at_least(result.maxima.tfce, result.tfce, result.t);
  result.q2 = q2.front();
  const double limit = result.q2 - 1e-9 * std::fabs(result.q2);
  result.q2_p = static_cast<double>(std::count_if(q2.begin(), q2.end(), [&](double q) { return q >= limit; })) /
                static_cast<double>(q2.size());
  const std::vector<double>& y = data.values();
  std::size_t n_same = 0;  // orders of equal values are the same
  for (const StateOrder& order : orders.all) {
    bool same = true;
    for (std::size_t i = 0; i < order.size(); ++i) same = same && y[order[i]] == y[i];
    n_same += same ? 1U : 0U;
  }
  result.smallest_p = static_cast<double>(n_same) / static_cast<double>(orders.all.size());
  result.predicted.assign(values.size(), kNaN);
  for (std::size_t i = 0; i < y.size(); ++i) result.predicted[data.counted()[i]] = data.predict(orders.all.front(), i);
  return result;
}

}  // namespace espdiff
