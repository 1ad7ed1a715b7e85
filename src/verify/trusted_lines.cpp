// trusted_lines.cpp: finds again where a result is trusted, from positions, slip, residues and potentials.
#include "verify/trusted_lines.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "verify/mapped_file.h"

namespace espdiff {
namespace {

constexpr double kTrustedSlip_A = 3, kTrustedBorder_A = 0.2, kLeastCheckedArea_A2 = 5;
/// Of the area: slip and residues are single precision, and medians jump.
constexpr double kTrustTolerance = 2e-3;
using Partners = std::map<std::int32_t, std::int32_t>;

/// The partner of a vertex's residue; -1 for none.
std::int32_t partner_at(const MappedFile& file, const Partners& partner_of, std::uint32_t v) {
  const auto found = partner_of.find(static_cast<std::int32_t>(file.residue[v]));
  return found == partner_of.end() ? -1 : found->second;
}

std::set<std::pair<double, double>> neighbours_on_target(const MappedFile& file) {
  std::set<std::pair<double, double>> neighbours;
  for (const Triangle& t : file.matched()) {
    for (const std::uint32_t a : t) {
      for (const std::uint32_t b : t) neighbours.insert({file.target_residue[a], file.target_residue[b]});
    }
  }
  return neighbours;
}

/// [triangle] unmatched, corrupt, unpaired, slipped, on another residue, turned, without a potential, or 0. Side chains
/// that turned are trusted or not, as the run was asked for.
std::vector<int> reasons_by_mapping(const MappedFile& file, const Partners& partner_of) {
  const auto neighbours = neighbours_on_target(file);
  const auto is_own = [&](std::uint32_t v) {
    const double partner = partner_at(file, partner_of, v), there = file.target_residue[v];
    if (partner < 0 || there < 0) return false;
    return partner == there || (file.slip[v] <= kTrustedBorder_A && neighbours.count({partner, there}) > 0);
  };
  const auto at_least_two = [](const Triangle& t, const auto& holds) {
    return std::count_if(t.begin(), t.end(), holds) >= 2;
  };
  std::vector<int> reasons;
  for (std::size_t k = 0; k < file.triangles.size(); ++k) {
    const Triangle& t = file.triangles[k];
    const bool slips = (file.slip[t[0]] + file.slip[t[1]] + file.slip[t[2]]) / 3 > kTrustedSlip_A;
    int why = 0;
    if (!file.is_matched[k]) {
      why = 1;
    } else if (!file.is_valid[k]) {
      why = 2;
    } else if (!partner_of.empty() &&
               at_least_two(t, [&](std::uint32_t v) { return partner_at(file, partner_of, v) < 0; })) {
      why = 3;
    } else if (slips) {
      why = 4;
    } else if (!partner_of.empty() && !at_least_two(t, is_own)) {
      why = 5;
    } else if (at_least_two(t, [&](std::uint32_t v) { return file.turned[v] >= (file.why[k] == 8 ? 1 : 2); })) {
      why = 8;
    }
    reasons.push_back(why);
  }
  const std::vector<bool> known = file.with_potentials(std::vector<bool>(reasons.size(), true));
  for (std::size_t k = 0; k < reasons.size(); ++k) reasons[k] = reasons[k] == 0 && !known[k] ? 7 : reasons[k];
  return reasons;
}

/// Marks the residues whose difference over what is trusted so far is not that of their own surfaces.
void mark_residues(const MappedFile& file, const CsvTable& table, std::vector<int>& reasons) {
  const int own = column(table, "own_difference"), weight_at = column(table, "own_area");
  if (own < 0 || weight_at < 0) return;
  std::vector<bool> counts;
  for (const int why : reasons) counts.push_back(why == 0);
  const std::vector<double> weight = file.weights(counts);
  std::vector<double> area(table.rows.size(), 0), sum(table.rows.size(), 0), error(table.rows.size(), -1);
  for (std::size_t v = 0; v < weight.size(); ++v) {
    const double r = file.residue[v];
    if (weight[v] <= 0 || !(r >= 0) || r >= static_cast<double>(area.size())) continue;
    area[static_cast<std::size_t>(r)] += weight[v];
    sum[static_cast<std::size_t>(r)] += weight[v] * (file.potential_target[v] - file.potential_source[v]);
  }
  std::vector<std::pair<double, double>> errors;
  for (std::size_t r = 0; r < area.size(); ++r) {
    const double expected = table.number(r, static_cast<std::size_t>(own));
    if (!(area[r] >= kLeastCheckedArea_A2) || !std::isfinite(expected)) continue;
    error[r] = std::fabs(sum[r] / area[r] - expected);
    errors.emplace_back(error[r], table.number(r, static_cast<std::size_t>(weight_at)));
  }
  // The other part of the limit needs the residues' own potentials, which are in no file: a mark may be missing where
  // the recorded array has none.
  const double limit = 5 * 1.4826 * weighted_quantile(errors, 0.5);
  for (std::size_t k = 0; k < reasons.size(); ++k) {
    const Triangle& t = file.triangles[k];
    const auto n = std::count_if(t.begin(), t.end(), [&](std::uint32_t v) {
      return file.residue[v] >= 0 && file.residue[v] < static_cast<double>(error.size()) &&
             error[static_cast<std::size_t>(file.residue[v])] > limit;
    });
    if (reasons[k] == 0 && n >= 2 && file.why[k] == 6) reasons[k] = 6;
  }
}

}  // namespace

void add_trust_lines(const MappedFile& file, const CsvTable& table, const Partners& partner_of, Lines& lines) {
  std::vector<int> reasons = reasons_by_mapping(file, partner_of);
  if (!file.potential_source.empty()) mark_residues(file, table, reasons);
  double all = 0, other = 0;
  for (std::size_t k = 0; k < reasons.size(); ++k) {
    const bool needs_atoms = partner_of.empty() && (file.why[k] == 3 || file.why[k] == 5 || file.why[k] == 6);
    all += file.source_area(k);
    other += needs_atoms || reasons[k] == static_cast<int>(file.why[k]) ? 0 : file.source_area(k);
  }
  lines.add_deviation("OUT.vtp/why, share of the area that differs", other / all, kTrustTolerance);
  lines.cover("OUT.vtp/why");
}

}  // namespace espdiff
