// assign_chains.cpp: tries the superposition of each pair of equal chains.
#include "align/assign_chains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "base/progress.h"

namespace espdiff {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Another assignment must be this much better than that of the names.
constexpr double kBetterShare = 0.8, kBetter_A = 1;
/// Superpositions tried: every pair of up to 20 equal chains; of a larger assembly those of its first chains.
constexpr int kMostTried = 400;

Superposition superposition_of(const ChainPoints& points) {
  std::vector<Vec3d> moving, fixed;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [a, b] : points) {
    pairs.emplace_back(moving.size(), moving.size());
    moving.push_back(a);
    fixed.push_back(b);
  }
  return superpose(moving, fixed, pairs);
}

double mean_square(const ChainPoints& points, const RigidTransform& motion) {
  double sum = 0;
  for (const auto& [a, b] : points) {
    const Vec3d d = motion.apply(a) - b;
    sum += dot(d, d);
  }
  return sum / static_cast<double>(points.size());
}

/// The assignment of chains that a motion brings nearest to each other.
std::vector<std::ptrdiff_t> nearest_chains(const ChainAssignment& chains, const RigidTransform& motion) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < chains.points.size(); ++i) {
    for (std::size_t j = 0; j < chains.points[i].size(); ++j) {
      if (!chains.points[i][j].empty()) candidates.emplace_back(mean_square(chains.points[i][j], motion), i, j);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<std::ptrdiff_t> target_of(chains.points.size(), -1);
  std::vector<bool> taken(chains.points.empty() ? 0 : chains.points.front().size(), false);
  for (const auto& [square, i, j] : candidates) {
    if (target_of[i] >= 0 || taken[j]) continue;
    target_of[i] = static_cast<std::ptrdiff_t>(j);
    taken[j] = true;
  }
  return target_of;
}

std::size_t n_assigned(const std::vector<std::ptrdiff_t>& target_of) {
  return static_cast<std::size_t>(std::count_if(target_of.begin(), target_of.end(), [](auto j) { return j >= 0; }));
}

}  // namespace

double rmsd_of_arrangement(const ChainAssignment& chains, const std::vector<std::ptrdiff_t>& target_of) {
  ChainPoints all;
  for (std::size_t i = 0; i < target_of.size(); ++i) {
    if (target_of[i] < 0) continue;
    const ChainPoints& points = chains.points[i][static_cast<std::size_t>(target_of[i])];
    all.insert(all.end(), points.begin(), points.end());
  }
  try {
    return superposition_of(all).rmsd_A;
  } catch (const GeometryError&) {
    return kInfinity;
  }
}

std::vector<std::ptrdiff_t> assign_chains(const ChainAssignment& chains) {
  const double present = rmsd_of_arrangement(chains, chains.target_of);
  if (present <= kBetter_A) return chains.target_of;
  std::vector<std::ptrdiff_t> best = chains.target_of;
  double least = present;
  int n_tried = 0;
  for (const auto& row : chains.points) {
    CancelRequest().check();
    for (const ChainPoints& points : row) {
      if (points.size() < 3 || ++n_tried > kMostTried) continue;
      RigidTransform motion;
      try {
        motion = superposition_of(points).transform;
      } catch (const GeometryError&) {
        continue;
      }
      const std::vector<std::ptrdiff_t> target_of = nearest_chains(chains, motion);
      if (n_assigned(target_of) < n_assigned(chains.target_of)) continue;
      const double rmsd_A = rmsd_of_arrangement(chains, target_of);
      if (rmsd_A < least) {
        least = rmsd_A;
        best = target_of;
      }
    }
  }
  return least < kBetterShare * present && least < present - kBetter_A ? best : chains.target_of;
}

}  // namespace espdiff
