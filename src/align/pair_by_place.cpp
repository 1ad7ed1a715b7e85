// pair_by_place.cpp: the polymer's motion near a point, and the nearest residues of equal names.
#include "align/pair_by_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "align/geometry/superpose.h"
#include "base/error.h"

namespace espdiff {
namespace {

/// A ligand or ion farther than this from where the polymer's motion puts it lies elsewhere: the distance between two
/// neighbouring binding sites.
constexpr double kReach_A = 4;
/// Residues whose superposition moves a point: about those that line a binding site.
constexpr std::size_t kNeighbours = 16;
constexpr std::size_t kLeastPaired = 3;

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;
using Cell = std::tuple<std::string, int, int, int>;

Vec3d centroid(const ResidueView& view, std::size_t residue) {
  Vec3d sum{};
  for (const std::size_t i : view.atoms[residue]) sum += view.molecule->positions[i];
  return (1 / static_cast<double>(view.atoms[residue].size())) * sum;
}

/// A residue's C-alpha or P, otherwise its centroid.
Vec3d place(const ResidueView& view, std::size_t residue) {
  for (const std::size_t i : view.atoms[residue]) {
    const std::string& name = view.molecule->atoms[i].name;
    if (name == "CA" || name == "P") return view.molecule->positions[i];
  }
  return centroid(view, residue);
}

bool is_other(const ResidueView& view, std::size_t residue) {
  const ResidueKind kind = view.kinds[residue];
  return (kind == ResidueKind::kOther || kind == ResidueKind::kWater) && !view.atoms[residue].empty();
}

Cell cell_of(const std::string& name, const Vec3d& p) {
  return {name, static_cast<int>(std::floor(p.x / kReach_A)), static_cast<int>(std::floor(p.y / kReach_A)),
          static_cast<int>(std::floor(p.z / kReach_A))};
}

/// A residue of the source and where it is expected on the target.
struct Expected {
  std::size_t residue;
  Vec3d place;
};

/// All pairs within reach, nearest first.
std::vector<std::tuple<double, std::size_t, std::size_t>> candidates(const ResidueView& source,
                                                                     const std::vector<Expected>& expected,
                                                                     const ResidueView& target) {
  std::map<Cell, std::vector<std::size_t>> cells;
  for (std::size_t r = 0; r < target.kinds.size(); ++r) {
    if (is_other(target, r)) cells[cell_of(target.molecule->residues[r].name, centroid(target, r))].push_back(r);
  }
  std::vector<std::tuple<double, std::size_t, std::size_t>> found;
  for (const Expected& e : expected) {
    const auto [name, x, y, z] = cell_of(source.molecule->residues[e.residue].name, e.place);
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const auto cell = cells.find({name, x + i, y + j, z + k});
          if (cell == cells.end()) continue;
          for (const std::size_t r : cell->second) {
            const double distance = norm(centroid(target, r) - e.place);
            if (distance <= kReach_A) found.emplace_back(distance, e.residue, r);
          }
        }
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

PolymerMotion::PolymerMotion(const ResidueView& source, const ResidueView& target, const IndexPairs& polymer) {
  for (const auto& [a, b] : polymer) {
    if (source.atoms[a].empty() || target.atoms[b].empty()) continue;
    source_.push_back(place(source, a));
    target_.push_back(place(target, b));
  }
}

bool PolymerMotion::known() const { return source_.size() >= kLeastPaired; }

Vec3d PolymerMotion::apply(const Vec3d& point) const {
  std::vector<std::pair<double, std::size_t>> by_distance;
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const Vec3d d = source_[i] - point;
    by_distance.emplace_back(dot(d, d), i);
  }
  const std::size_t n = std::min(kNeighbours, by_distance.size());
  std::partial_sort(by_distance.begin(), by_distance.begin() + static_cast<std::ptrdiff_t>(n), by_distance.end());
  IndexPairs near;
  for (std::size_t k = 0; k < n; ++k) near.emplace_back(by_distance[k].second, by_distance[k].second);
  try {
    return superpose(source_, target_, near).transform.apply(point);
  } catch (const GeometryError&) {
    return point + target_[near.front().first] - source_[near.front().first];  // all on a line
  }
}

IndexPairs pair_by_place(const ResidueView& source, const ResidueView& target, const PolymerMotion& motion,
                         std::vector<MovedResidue>& moved) {
  std::vector<Expected> expected;
  for (std::size_t r = 0; r < source.kinds.size(); ++r) {
    if (is_other(source, r)) expected.push_back({r, motion.apply(centroid(source, r))});
  }
  IndexPairs pairs;
  std::vector<bool> source_taken(source.kinds.size(), false), target_taken(target.kinds.size(), false);
  for (const auto& [distance, s, t] : candidates(source, expected, target)) {
    if (source_taken[s] || target_taken[t]) continue;
    source_taken[s] = target_taken[t] = true;
    pairs.emplace_back(s, t);
  }
  for (const Expected& e : expected) {
    if (source_taken[e.residue] || source.kinds[e.residue] == ResidueKind::kWater) continue;
    MovedResidue nearest{e.residue, 0, INFINITY};
    for (std::size_t r = 0; r < target.kinds.size(); ++r) {
      if (target_taken[r] || !is_other(target, r)) continue;
      if (target.molecule->residues[r].name != source.molecule->residues[e.residue].name) continue;
      const double distance = norm(centroid(target, r) - e.place);
      if (distance < nearest.distance_A) nearest = {e.residue, r, distance};
    }
    if (nearest.distance_A < INFINITY) moved.push_back(nearest);
  }
  return pairs;
}

bool in_place(const ResidueView& source, const ResidueView& target, const PolymerMotion& motion,
              const IndexPairs& others) {
  return std::all_of(others.begin(), others.end(), [&](const auto& pair) {
    return norm(motion.apply(centroid(source, pair.first)) - centroid(target, pair.second)) <= kReach_A;
  });
}

}  // namespace espdiff
