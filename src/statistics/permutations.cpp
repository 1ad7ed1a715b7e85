// permutations.cpp: enumerates or draws the labels of replicates.
#include "statistics/permutations.h"

#include <algorithm>
#include <numeric>

#include "base/counter_random.h"

namespace espdiff {
namespace {

using Order = std::vector<std::uint32_t>;

/// The order whose first group has the marked replicates.
Order order_of(const std::vector<char>& in_first) {
  Order order;
  for (const bool first : {true, false}) {
    for (std::uint32_t r = 0; r < in_first.size(); ++r) {
      if ((in_first[r] != 0) == first) order.push_back(r);
    }
  }
  return order;
}

/// A random choice of the first group: a partial shuffle (Fisher and Yates).
Order random_order(std::size_t n_first, std::size_t n, std::uint64_t seed, std::uint64_t permutation) {
  Order all(n);
  std::iota(all.begin(), all.end(), 0U);
  std::vector<char> in_first(n, 0);
  for (std::size_t i = 0; i < n_first; ++i) {
    std::swap(all[i], all[i + random_below(n - i, seed, permutation, i)]);
    in_first[all[i]] = 1;
  }
  return order_of(in_first);
}

}  // namespace

std::uint64_t count_permutations(std::size_t n_first, std::size_t n_second) {
  constexpr std::uint64_t kMany = std::uint64_t{1} << 63;
  std::uint64_t count = 1;
  for (std::size_t i = 1; i <= std::min(n_first, n_second); ++i) {
    const std::uint64_t factor = n_first + n_second - std::min(n_first, n_second) + i;
    if (count > kMany / factor) return kMany;
    count = count * factor / i;
  }
  return count;
}

double smallest_p(std::size_t n_first, std::size_t n_second, std::uint64_t most) {
  const std::uint64_t possible = count_permutations(n_first, n_second);
  if (possible > most) return 1.0 / static_cast<double>(most);
  return (n_first == n_second ? 2.0 : 1.0) / static_cast<double>(possible);
}

double Permutations::smallest_p() const {
  return exact ? espdiff::smallest_p(n_first, n_second, n_possible) : 1.0 / static_cast<double>(orders.size());
}

Permutations make_permutations(std::size_t n_first, std::size_t n_second, std::uint64_t most, std::uint64_t seed) {
  Permutations all;
  all.n_first = n_first;
  all.n_second = n_second;
  all.n_possible = count_permutations(n_first, n_second);
  all.exact = all.n_possible <= most;
  const std::size_t n = n_first + n_second;
  std::vector<char> in_first(n, 0);
  std::fill_n(in_first.begin(), n_first, 1);
  if (all.exact) {
    do all.orders.push_back(order_of(in_first));
    while (std::prev_permutation(in_first.begin(), in_first.end()));
    return all;
  }
  all.orders.push_back(order_of(in_first));
  for (std::uint64_t k = 1; k < most; ++k) all.orders.push_back(random_order(n_first, n, seed, k));
  return all;
}

}  // namespace espdiff
