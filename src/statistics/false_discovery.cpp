// false_discovery.cpp: Benjamini and Hochberg's step-up procedure.
#include "statistics/false_discovery.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace espdiff {

std::vector<double> adjust_for_false_discovery(const std::vector<double>& p) {
  std::vector<std::size_t> tested;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!std::isnan(p[i])) tested.push_back(i);
  }
  std::stable_sort(tested.begin(), tested.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted = p;
  double smallest = 1;
  for (std::size_t rank = tested.size(); rank > 0; --rank) {
    const std::size_t i = tested[rank - 1];
    smallest = std::min(smallest, p[i] * static_cast<double>(tested.size()) / static_cast<double>(rank));
    adjusted[i] = smallest;
  }
  return adjusted;
}

}  // namespace espdiff
