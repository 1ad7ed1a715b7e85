// balanced_splits.h: groups that do not differ, made of simulations of two states that do.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "statistics/permutations.h"

namespace espdiff_test {

/// All choices of half of each state's replicates against the other half of each, as numbers of replicates: the first
/// group's, then the second's. Every split has a mirror image.
inline std::vector<std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> balanced_splits(
    const std::vector<std::size_t>& first, const std::vector<std::size_t>& second) {
  std::vector<std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> splits;
  const std::size_t half_first = first.size() / 2, half_second = second.size() / 2;
  for (const auto& a : espdiff::make_permutations(half_first, first.size() - half_first).orders) {
    for (const auto& b : espdiff::make_permutations(half_second, second.size() - half_second).orders) {
      splits.emplace_back();
      auto& [one, two] = splits.back();
      for (std::size_t i = 0; i < a.size(); ++i) (i < half_first ? one : two).push_back(first[a[i]]);
      for (std::size_t i = 0; i < b.size(); ++i) (i < half_second ? one : two).push_back(second[b[i]]);
    }
  }
  return splits;
}

}  // namespace espdiff_test
