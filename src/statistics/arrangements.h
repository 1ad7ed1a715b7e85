// arrangements.h: exchanges of the labels of replicates between two groups.
#pragma once

#include <cstdint>
#include <vector>

namespace espdiff {

/// The arrangements that a permutation test goes through: all of them, or a random sample.
struct Arrangements {
  std::size_t n_first = 0, n_second = 0;  ///< replicates of the groups
  std::uint64_t n_possible = 0;           ///< saturates at 2^63
  bool exact = true;                      ///< all arrangements; otherwise a random sample with the observed one
  /// [arrangement][place] replicates of the first group, then of the second, each in rising order. The first
  /// arrangement is the observed one.
  std::vector<std::vector<std::uint32_t>> orders;

  /// The smallest p of a two-sided test that the arrangements allow: with groups of equal size, exchanging all labels
  /// only turns the sign.
  double smallest_p() const;
};

/// How many arrangements are enumerated or drawn at most.
constexpr std::uint64_t kMostArrangements = 10000;
constexpr std::uint64_t kSeedOfLabels = 20221;

/// (n_first + n_second) choose n_first; saturates at 2^63.
std::uint64_t count_arrangements(std::size_t n_first, std::size_t n_second);
/// What Arrangements::smallest_p() is, before anything is computed.
double smallest_p(std::size_t n_first, std::size_t n_second, std::uint64_t most = kMostArrangements);

/// All arrangements in lexicographic order if they are not more than `most`; otherwise the observed one and most - 1
/// random ones.
Arrangements make_arrangements(std::size_t n_first, std::size_t n_second, std::uint64_t most = kMostArrangements,
                               std::uint64_t seed = kSeedOfLabels);

}  // namespace espdiff
