// assign_chains.h: which of several equal chains correspond, by their arrangement in space.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Corresponding points of two chains: (C-alpha or P of the source, of the target), about 30 of them.
using ChainPoints = std::vector<std::pair<Vec3d, Vec3d>>;

/// Equal chains of two molecules, and their present assignment.
struct ChainAssignment {
  /// [source chain][target chain] corresponding points; empty if the chains are not equal.
  std::vector<std::vector<ChainPoints>> points;
  std::vector<std::ptrdiff_t> target_of;  ///< [source chain] -1 for none
};

/// The RMSD of all assigned chains after their superposition.
double rmsd_of_arrangement(const ChainAssignment& chains, const std::vector<std::ptrdiff_t>& target_of);

/// The assignment of equal chains with the least RMSD. Each pair of equal chains is superposed in turn, and the others
/// follow, nearest first. The present assignment stays unless another has less than 0.8 of its RMSD and 1 A less, so
/// that names decide between assignments that fit alike.
/// @returns [source chain] target chain, -1 for none. Time O(n^3) in the number of equal chains.
std::vector<std::ptrdiff_t> assign_chains(const ChainAssignment& chains);

}  // namespace espdiff
