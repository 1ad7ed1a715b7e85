// smooth_field.cpp: sums over the corners of triangles; in a closed mesh each neighbour of a vertex is met twice.
#include "base/smooth_field.h"

#include <cmath>
#include <utility>

namespace espdiff {

std::vector<float> smoothed_over_neighbours(const std::vector<Triangle>& triangles, std::vector<float> values,
                                            int rounds) {
  std::vector<float> sum, n_met;
  for (int round = 0; round < rounds; ++round) {
    sum.assign(values.size(), 0);
    n_met.assign(values.size(), 0);
    for (const Triangle& t : triangles) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const float value = values[t[corner]];
        if (std::isnan(value)) continue;
        for (const std::size_t other : {(corner + 1) % 3, (corner + 2) % 3}) {
          sum[t[other]] += value;
          n_met[t[other]] += 1;
        }
      }
    }
    for (std::size_t v = 0; v < values.size(); ++v)
      if (n_met[v] > 0) values[v] = 0.5F * (values[v] + sum[v] / n_met[v]);
  }
  return values;
}

std::vector<float> drawn_uncertainty(const std::vector<Triangle>& triangles, std::vector<float> uncertainty) {
  constexpr int kRounds = 5;
  return smoothed_over_neighbours(triangles, std::move(uncertainty), kRounds);
}

}  // namespace espdiff
