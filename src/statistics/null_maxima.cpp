// null_maxima.cpp: shares of the largest values, and places with their intervals.
#include "statistics/null_maxima.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/surface/mesh_graph.h"
#include "statistics/welch.h"

namespace espdiff {

double mean_abs(const std::vector<double>& values, const MeshGraph& graph) {
  double sum = 0, area = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!std::isfinite(values[v])) continue;
    sum += graph.area[v] * std::fabs(values[v]);
    area += graph.area[v];
  }
  return sum / area;
}

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::fabs(value));
  }
  return largest;
}

/// Equal values of different order of summation count as equal.
double share_at_least(const std::vector<double>& sorted, double value) {
  const double limit = std::fabs(value) * (1 - 1e-9);
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), limit);
  return static_cast<double>(sorted.end() - first) / static_cast<double>(sorted.size());
}

std::vector<double> shares_at_least(std::vector<double> maxima, const std::vector<double>& values,
                                    const std::vector<double>& tested) {
  std::sort(maxima.begin(), maxima.end());
  std::vector<double> p(values.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (std::isfinite(tested[v])) p[v] = share_at_least(maxima, values[v]);
  }
  return p;
}

void add_place(PlaceTests& tests, const WelchTest& test, double confidence) {
  const double half = student_quantile(confidence, test.degrees) * test.error;
  tests.difference.push_back(test.difference);
  tests.error.push_back(test.error);
  tests.degrees.push_back(test.degrees);
  tests.t.push_back(test.t);
  tests.p.push_back(test.p);
  tests.low.push_back(test.difference - half);
  tests.high.push_back(test.difference + half);
}

void move_to(PlaceTests& tests, std::size_t place, double difference) {
  const double by = difference - tests.difference[place];
  tests.difference[place] = difference;
  tests.low[place] += by;
  tests.high[place] += by;
}

}  // namespace espdiff
