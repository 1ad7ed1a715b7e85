// permutations.h: exchanges of the labels of replicates between two groups.
#pragma once

#include <cstdint>
#include <vector>

namespace espdiff {

/// The permutations that a permutation test goes through: all of them, or a random sample.
struct Permutations {
  std::size_t n_first = 0, n_second = 0;  ///< replicates of the groups
  std::uint64_t n_possible = 0;           ///< saturates at 2^63
  bool exact = true;                      ///< all permutations; otherwise a random sample with the observed one
  /// [permutation][place] replicates of the first group, then of the second, each in rising order. The first
  /// permutation is the observed one.
  std::vector<std::vector<std::uint32_t>> orders;

  /// The smallest p of a two-sided test that the permutations allow: with groups of equal size, exchanging all labels
  /// only turns the sign.
  double smallest_p() const;
};

/// How many permutations are enumerated or drawn at most.
constexpr std::uint64_t kMaxPermutations = 10000;
constexpr std::uint64_t kSeedOfLabels = 20221;

/// (n_first + n_second) choose n_first; saturates at 2^63.
std::uint64_t count_permutations(std::size_t n_first, std::size_t n_second);
/// What Permutations::smallest_p() is, before anything is computed.
double smallest_p(std::size_t n_first, std::size_t n_second, std::uint64_t most = kMaxPermutations);

/// All permutations in lexicographic order if they are not more than `most`; otherwise the observed one and most - 1
/// random ones.
Permutations make_permutations(std::size_t n_first, std::size_t n_second, std::uint64_t most = kMaxPermutations,
                               std::uint64_t seed = kSeedOfLabels);

}  // namespace espdiff
