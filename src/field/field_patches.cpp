// field_patches.cpp: connected areas beyond a threshold, and their partners in the other state.
#include "field/field_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "base/triangle_areas.h"
#include "field/field_result.h"

namespace espdiff {
namespace {

/// The part of a triangle above the threshold, by linear interpolation: area, and the integral of the value over it.
struct PartAbove {
  double area = 0, integral = 0;
};

PartAbove part_above(double full, std::array<double, 3> v, double threshold) {
  std::sort(v.begin(), v.end());
  if (v[0] > threshold) return {full, full * (v[0] + v[1] + v[2]) / 3};
  if (v[2] <= threshold) return {};
  const auto corner = [&](double apex, double a, double b) {  // cut off at the corner of value `apex`
    const double area = full * (threshold - apex) / (a - apex) * (threshold - apex) / (b - apex);
    return PartAbove{area, area * (apex + 2 * threshold) / 3};
  };
  if (v[1] <= threshold) return corner(v[2], v[0], v[1]);
  const PartAbove below = corner(v[0], v[1], v[2]);
  return {full - below.area, full * (v[0] + v[1] + v[2]) / 3 - below.integral};
}

/// Vertices joined by edges; the representative is the smallest vertex.
class JoinedVertices {
 public:
  explicit JoinedVertices(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t root(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// A patch with its first vertex, before it has a number.
struct FoundPatch {
  std::uint32_t root = 0;
  FieldPatch patch;
};

/// The patches of one state above `threshold` of sign * value.
class PatchSearch {
 public:
  PatchSearch(const std::vector<Triangle>& triangles, const PatchedState& state, const std::vector<std::uint8_t>& why,
              double sign, double threshold)
      : triangles_(triangles),
        state_(state),
        why_(why),
        sign_(sign),
        threshold_(threshold),
        joined_(state.positions.size()) {
    join();
    measure();
  }

  std::vector<FoundPatch> patches() const {
    std::vector<FoundPatch> found;
    for (const auto& [root, sums] : sums_) {
      FieldPatch patch;
      patch.is_above = sign_ > 0;
      patch.area_A2 = sums.area;
      patch.trusted_area_A2 = sums.trusted;
      patch.mean = sign_ * sums.integral / sums.area;
      patch.extreme = sign_ * sums.extreme;
      patch.residues.assign(sums.residues.begin(), sums.residues.end());
      std::stable_sort(patch.residues.begin(), patch.residues.end(),
                       [](const auto& a, const auto& b) { return a.second > b.second; });
      found.push_back({root, std::move(patch)});
    }
    return found;
  }
  bool is_above(std::uint32_t v) const { return value(v) > threshold_; }
  std::uint32_t root(std::uint32_t v) { return joined_.root(v); }

 private:
  struct Sums {
    double area = 0, trusted = 0, integral = 0, extreme = -std::numeric_limits<double>::infinity();
    std::map<std::int32_t, double> residues;
  };

  double value(std::uint32_t v) const { return sign_ * static_cast<double>(state_.values[v]); }
  bool counts(std::size_t t) const {
    return (state_.left_out.empty() || state_.left_out[t] == 0) &&
           std::all_of(triangles_[t].begin(), triangles_[t].end(),
                       [&](std::uint32_t v) { return std::isfinite(state_.values[v]); });
  }

  void join() {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!counts(t)) continue;
      const Triangle& corner = triangles_[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = corner[i], b = corner[(i + 1) % 3];
        if (is_above(a) && is_above(b)) joined_.join(a, b);
      }
    }
  }

  void measure() {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!counts(t)) continue;
      const Triangle& c = triangles_[t];
      std::vector<std::uint32_t> above;
      for (const std::uint32_t v : c) {
        if (is_above(v)) above.push_back(v);
      }
      if (above.empty()) continue;
      const std::vector<Vec3d>& p = state_.positions;
      const PartAbove part = part_above(triangle_area(p, c), {value(c[0]), value(c[1]), value(c[2])}, threshold_);
      if (!(part.area > 0)) continue;
      Sums& sums = sums_[joined_.root(above.front())];
      sums.area += part.area;
      sums.integral += part.integral;
      if (why_[t] == 0) sums.trusted += part.area;
      for (const std::uint32_t v : above) {
        sums.extreme = std::max(sums.extreme, value(v));
        if (state_.residue[v] >= 0) sums.residues[state_.residue[v]] += part.area / static_cast<double>(above.size());
      }
    }
  }

  const std::vector<Triangle>& triangles_;
  const PatchedState& state_;
  const std::vector<std::uint8_t>& why_;
  double sign_, threshold_;
  JoinedVertices joined_;
  std::map<std::uint32_t, Sums> sums_;
};

/// The patches of one state on both sides of the request, numbered, and each vertex' number.
void find_in_state(const PatchesRequest& request, const std::vector<Triangle>& triangles, const PatchedState& state,
                   const std::vector<std::uint8_t>& why, std::vector<FieldPatch>& patches,
                   std::vector<std::int32_t>& number, std::size_t& n_small) {
  std::vector<PatchSearch> searches;
  if (request.above) searches.emplace_back(triangles, state, why, 1, *request.above);
  if (request.below) searches.emplace_back(triangles, state, why, -1, -*request.below);
  std::vector<std::pair<std::size_t, FoundPatch>> found;
  for (std::size_t s = 0; s < searches.size(); ++s) {
    for (FoundPatch& patch : searches[s].patches()) {
      if (patch.patch.area_A2 < kLeastFieldPatch_A2)
        ++n_small;
      else
        found.emplace_back(s, std::move(patch));
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.second.patch.area_A2 > b.second.patch.area_A2; });
  std::map<std::pair<std::size_t, std::uint32_t>, std::int32_t> numbers;
  for (auto& [search, patch] : found) {
    patches.push_back(std::move(patch.patch));
    numbers[{search, patch.root}] = static_cast<std::int32_t>(patches.size());
  }
  number.assign(state.positions.size(), 0);
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    for (std::size_t s = 0; s < searches.size(); ++s) {
      if (!searches[s].is_above(v)) continue;
      const auto at = numbers.find({s, searches[s].root(v)});
      if (at != numbers.end()) number[v] = at->second;
    }
  }
}

/// Which patches lie on each other, by the trusted area on the source that their vertices share.
void find_others(FieldPatches& patches, const std::vector<double>& area) {
  constexpr double kShare = 0.1;
  std::map<std::pair<std::size_t, std::size_t>, double> shared;
  for (std::size_t v = 0; v < area.size(); ++v) {
    const std::int32_t s = patches.source_patch[v], t = patches.target_patch[v];
    if (s > 0 && t > 0) shared[{static_cast<std::size_t>(s), static_cast<std::size_t>(t)}] += area[v];
  }
  for (const auto& [pair, together] : shared) {
    FieldPatch &s = patches.source[pair.first - 1], &t = patches.target[pair.second - 1];
    const double least = std::min(kLeastFieldPatch_A2, kShare * std::min(s.trusted_area_A2, t.trusted_area_A2));
    if (s.is_above != t.is_above || !(together > least)) continue;
    s.others.push_back(pair.second);
    t.others.push_back(pair.first);
  }
}

PatchFate fate_of_pair(const FieldPatch& source, const FieldPatch& target) {
  constexpr double kSame = 1.25;
  if (target.trusted_area_A2 > kSame * source.trusted_area_A2) return PatchFate::kGrew;
  if (kSame * target.trusted_area_A2 < source.trusted_area_A2) return PatchFate::kShrank;
  return PatchFate::kUnchanged;
}

PatchFate fate_of(const FieldPatch& patch, bool of_source, const std::vector<FieldPatch>& others) {
  if (patch.others.empty()) {
    if (2 * patch.trusted_area_A2 < patch.area_A2) return PatchFate::kUnknown;
    return of_source ? PatchFate::kVanished : PatchFate::kAppeared;
  }
  if (patch.others.size() > 1) return of_source ? PatchFate::kSplit : PatchFate::kMerged;
  const FieldPatch& other = others[patch.others.front() - 1];
  if (other.others.size() > 1) return of_source ? PatchFate::kMerged : PatchFate::kSplit;
  return of_source ? fate_of_pair(patch, other) : fate_of_pair(other, patch);
}

}  // namespace

const char* to_string(PatchFate fate) {
  switch (fate) {
    case PatchFate::kUnchanged: return "unchanged";
    case PatchFate::kGrew: return "grew";
    case PatchFate::kShrank: return "shrank";
    case PatchFate::kSplit: return "split";
    case PatchFate::kMerged: return "merged";
    case PatchFate::kVanished: return "vanished";
    case PatchFate::kAppeared: return "appeared";
    case PatchFate::kUnknown: break;
  }
  return "unknown";
}

FieldPatches find_field_patches(const Quantity& quantity, const PatchesRequest& request,
                                const std::vector<Triangle>& triangles, const PatchedState& source,
                                const PatchedState& target, const std::vector<std::uint8_t>& why) {
  FieldPatches patches;
  patches.quantity = quantity;
  patches.request = request;
  find_in_state(request, triangles, source, why, patches.source, patches.source_patch, patches.n_small_source);
  find_in_state(request, triangles, target, why, patches.target, patches.target_patch, patches.n_small_target);
  find_others(patches, corner_areas(source.positions, triangles, [&](std::size_t t) { return why[t] == 0; }));
  for (FieldPatch& patch : patches.source) patch.fate = fate_of(patch, true, patches.target);
  for (FieldPatch& patch : patches.target) patch.fate = fate_of(patch, false, patches.source);
  return patches;
}

}  // namespace espdiff
