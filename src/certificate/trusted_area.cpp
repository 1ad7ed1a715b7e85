// trusted_area.cpp: the verdict on each triangle, and its sums.
#include "certificate/trusted_area.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/formatted.h"
#include "base/molecule/residue_label.h"
#include "base/not_a_number.h"
#include "base/triangle_areas.h"
#include "certificate/result.h"
#include "certificate/turned_side_chains.h"

namespace espdiff {
namespace {

using ResiduePair = std::pair<std::int32_t, std::int32_t>;

std::uint8_t code(Why why) { return static_cast<std::uint8_t>(why); }

bool is_matched(const MappedSurface& s, std::size_t t) { return s.unmatched.empty() || s.unmatched[t] == 0; }

/// Pairs of the target's residues that share a triangle of the mapped surface, smaller first, sorted.
std::vector<ResiduePair> touching_residues(const MappedSurface& s) {
  std::vector<ResiduePair> touching;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (!is_matched(s, t)) continue;
    const Triangle& v = s.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = s.target_residue[v[k]], b = s.target_residue[v[(k + 1) % 3]];
      if (a != b) touching.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  return touching;
}

bool slipped(const MappedSurface& s, const Triangle& v) {
  if (s.slip.empty()) return false;
  return (s.slip[v[0]] + s.slip[v[1]] + s.slip[v[2]]) / 3 > static_cast<float>(kLargeSlip_A);  // not where unknown
}

/// [vertex] whether it lies on its paired residue, or within kBorder_A of it on one that touches it.
std::vector<std::uint8_t> on_own_residue(const MappedSurface& s, const std::vector<std::int32_t>& target_of) {
  const std::vector<ResiduePair> touching = touching_residues(s);
  const auto touches = [&](std::int32_t a, std::int32_t b) {
    return std::binary_search(touching.begin(), touching.end(), ResiduePair{std::min(a, b), std::max(a, b)});
  };
  std::vector<std::uint8_t> own(s.residue.size(), 0);
  const auto n = static_cast<std::ptrdiff_t>(own.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t vertex = 0; vertex < n; ++vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    const std::int32_t partner = s.residue[v] < 0 ? -1 : target_of[static_cast<std::size_t>(s.residue[v])],
                       there = s.target_residue[v];
    if (partner < 0 || there < 0) continue;
    const bool near = !s.slip.empty() && s.slip[v] <= static_cast<float>(kBorder_A);
    own[v] = partner == there || (near && touches(partner, there));
  }
  return own;
}

}  // namespace

const char* key_of(Why why) {
  switch (why) {
    case Why::kTrusted: return "trusted";
    case Why::kUnmatched: return "unmatched";
    case Why::kCorrupt: return "corrupt";
    case Why::kUnpaired: return "unpaired";
    case Why::kSlipped: return "slipped";
    case Why::kOtherResidue: return "other_residue";
    case Why::kDisagrees: return "disagrees";
    case Why::kTurned: return "turned";
    case Why::kNoPotential: break;
  }
  return "no_potential";
}

std::vector<std::uint8_t> why_of_mapping(const MappedSurface& s, const std::vector<std::int32_t>& target_of,
                                         KeptTurns kept) {
  const bool judges_residues = std::any_of(target_of.begin(), target_of.end(), [](std::int32_t r) { return r >= 0; });
  std::vector<std::uint8_t> own;
  if (judges_residues) own = on_own_residue(s, target_of);
  const auto count = [](const Triangle& v, const auto& holds) { return std::count_if(v.begin(), v.end(), holds); };
  const auto has_no_partner = [&](std::uint32_t c) {
    return s.residue[c] < 0 || target_of[static_cast<std::size_t>(s.residue[c])] < 0;
  };
  const auto turned_away = [&](std::uint32_t c) {
    const auto turn = s.turned.empty() ? Turn::kNone : static_cast<Turn>(s.turned[c]);
    return turn == Turn::kResidue || (turn == Turn::kSideChain && kept == KeptTurns::kNone) ||
           (turn == Turn::kFarSideChain && kept != KeptTurns::kAll);
  };
  std::vector<std::uint8_t> why(s.triangles.size());
  const auto n = static_cast<std::ptrdiff_t>(why.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t triangle = 0; triangle < n; ++triangle) {
    const auto t = static_cast<std::size_t>(triangle);
    const Triangle& v = s.triangles[t];
    Why first = Why::kTrusted;
    if (!is_matched(s, t)) {
      first = Why::kUnmatched;
    } else if (s.corrupt[t] != 0) {
      first = Why::kCorrupt;
    } else if (judges_residues && count(v, has_no_partner) >= 2) {
      first = Why::kUnpaired;
    } else if (slipped(s, v)) {
      first = Why::kSlipped;
    } else if (judges_residues && count(v, [&](std::uint32_t c) { return own[c] != 0; }) < 2) {
      first = Why::kOtherResidue;
    } else if (count(v, turned_away) >= 2) {
      first = Why::kTurned;
    }
    why[t] = code(first);
  }
  return why;
}

void mark_without_potential(MappedSurface& s) {
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.why[t] != code(Why::kTrusted)) continue;
    for (const std::uint32_t v : s.triangles[t]) {
      if (!std::isfinite(s.potential_source[v]) || !std::isfinite(s.potential_target[v]))
        s.why[t] = code(Why::kNoPotential);
    }
  }
}

void mark_disagreeing(MappedSurface& s, const std::vector<std::uint8_t>& residues) {
  const auto disagrees = [&](std::uint32_t v) {
    return s.residue[v] >= 0 && residues[static_cast<std::size_t>(s.residue[v])] != 0;
  };
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const Triangle& v = s.triangles[t];
    if (s.why[t] == code(Why::kTrusted) && std::count_if(v.begin(), v.end(), disagrees) >= 2)
      s.why[t] = code(Why::kDisagrees);
  }
}

std::vector<std::uint8_t> trusted_vertices(const MappedSurface& s) {
  std::vector<int> balance(s.positions.size(), 0);
  std::vector<std::uint8_t> trusted(s.positions.size(), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    for (const std::uint32_t v : s.triangles[t]) {
      balance[v] += s.why[t] == code(Why::kTrusted) ? 1 : -1;
      trusted[v] = 1;
    }
  }
  for (std::size_t v = 0; v < trusted.size(); ++v) trusted[v] = trusted[v] != 0 && balance[v] >= 0 ? 1 : 0;
  return trusted;
}

std::vector<float> untrusted_triangles(const MappedSurface& s) {
  std::vector<float> untrusted;
  untrusted.reserve(s.why.size());
  for (const std::uint8_t why : s.why) untrusted.push_back(why != code(Why::kTrusted) ? 1.0F : 0.0F);
  return untrusted;
}

TrustedArea sum_trusted(const MappedSurface& s, const SurfaceAreas& areas, const std::vector<float>& outside,
                        double unmatched_target) {
  TrustedArea sums;
  double source = 0, matched = 0, trusted = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (!outside.empty() && outside[t] != 0) continue;
    const double before = areas.source[t];
    source += before;
    sums.by_why[s.why[t]] += before;
    if (!is_matched(s, t)) continue;
    const double after = areas.mapped[t];
    matched += after;
    trusted += s.why[t] == code(Why::kTrusted) ? after : 0;
  }
  for (double& share : sums.by_why) share = source > 0 ? share / source : kNaN;
  sums.source = sums.by_why[code(Why::kTrusted)];
  sums.target = matched > 0 ? (1 - unmatched_target) * trusted / matched : kNaN;
  return sums;
}

TurnedArea turned_area(const MappedSurface& s, const SurfaceAreas& areas, const std::vector<float>& outside,
                       const Molecule& source) {
  double trusted = 0, turned = 0, rest = 0, difference = 0;
  std::vector<std::pair<double, std::size_t>> by_residue(source.residues.size());
  for (std::size_t r = 0; r < by_residue.size(); ++r) by_residue[r] = {0, r};
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.why[t] != code(Why::kTrusted) || (!outside.empty() && outside[t] != 0)) continue;
    const Triangle& corners = s.triangles[t];
    const double before = areas.source[t];
    trusted += before;
    const auto is_turned = [&](std::uint32_t v) { return s.turned[v] != 0; };
    if (!s.turned.empty() && std::count_if(corners.begin(), corners.end(), is_turned) >= 2) {
      turned += before;
      for (const std::uint32_t v : corners) {
        if (s.turned[v] != 0 && s.residue[v] >= 0) by_residue[static_cast<std::size_t>(s.residue[v])].first += before;
      }
      continue;
    }
    if (s.potential_source.empty()) continue;
    const double after = areas.mapped[t];  // the weight of the metrics
    rest += after;
    for (const std::uint32_t v : corners)
      difference += after / 3 *
                    std::fabs(static_cast<double>(s.potential_target[v]) - static_cast<double>(s.potential_source[v]));
  }
  std::stable_sort(by_residue.begin(), by_residue.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  TurnedArea sums{trusted > 0 ? turned / trusted : kNaN, rest > 0 ? difference / rest : kNaN, {}};
  for (const auto& [area, r] : by_residue) {
    if (area > 0) sums.side_chains.push_back(residue_label(source.residues[r]));
  }
  return sums;
}

WholeSurface whole_surface(const MappedSurface& s, const std::vector<ResidueRow>& residues,
                           const PotentialComparison& potential) {
  if (!potential.compared || !(potential.metrics.area_A2 > 0)) return {kNaN, kNaN};
  double largest = 0;
  for (std::size_t v = 0; v < s.potential_source.size(); ++v) {
    const double d = std::fabs(static_cast<double>(s.potential_target[v]) - static_cast<double>(s.potential_source[v]));
    if (std::isfinite(d)) largest = std::max(largest, d);
  }
  std::vector<double> rest(residues.size(), 0.0);
  double all = 0, left_out = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const double area = triangle_area(s.source_positions, s.triangles[t]);
    all += area;
    if (s.why[t] == code(Why::kTrusted)) continue;
    left_out += area;
    for (const std::uint32_t v : s.triangles[t]) {
      if (s.residue[v] >= 0) rest[static_cast<std::size_t>(s.residue[v])] += area / 3;
    }
  }
  double mapped = 0, own = 0, estimated = 0, known = 0;
  for (const ResidueRow& row : residues) {
    if (!std::isfinite(row.own_difference)) continue;
    known += rest[row.residue];
    estimated += rest[row.residue] * std::fabs(row.own_difference);
    if (!(row.area_A2 > 0)) continue;
    mapped += row.area_A2 * row.mean_abs_difference;
    own += row.area_A2 * std::fabs(row.own_difference);
  }
  const double mean = potential.metrics.mean_abs_difference, ratio = own > 0 ? mapped / own : 1;
  const double of_rest = ratio * estimated + (left_out - known) * mean;
  return {((all - left_out) * mean + of_rest) / all, ((all - left_out) * mean + left_out * largest) / all};
}

std::string verdict_of(const Certificate& c) {
  if (!c.trustworthy) return "NOT TRUSTWORTHY";
  const double share = c.trusted.share();
  if (!(share < kWholeShare)) return "TRUSTWORTHY";
  return formatted("TRUSTWORTHY ON %.0f %%", std::floor(100 * share));
}

}  // namespace espdiff
