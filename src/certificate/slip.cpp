// slip.cpp: area-weighted quantiles of the slip, and its limits over the whole area and by its parts.
#include "certificate/slip.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>

#include "align/geometry/rigid_domains.h"
#include "align/residue_names.h"
#include "base/molecule/residue_label.h"
#include "base/not_a_number.h"
#include "base/text/short_numbers.h"
#include "base/triangle_areas.h"

namespace espdiff {
namespace {

struct SlippedArea {
  float slip;
  double area;
};

/// Smallest slip first, then smallest area: by the digits of the slip, whose bits have the order of its values.
void sort_by_slip(std::vector<SlippedArea>& areas) {
  constexpr unsigned kDigit = 11, kDigits = 3;
  std::vector<SlippedArea> sorted(areas.size());
  for (unsigned digit = 0; digit < kDigits; ++digit) {
    const auto place = [&](const SlippedArea& a) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &a.slip, sizeof bits);
      return bits >> digit * kDigit & ((1U << kDigit) - 1);
    };
    std::vector<std::size_t> first((1U << kDigit) + 1, 0);
    for (const SlippedArea& a : areas) ++first[place(a) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    for (const SlippedArea& a : areas) sorted[first[place(a)]++] = a;
    areas.swap(sorted);
  }
  for (auto begin = areas.begin(); begin != areas.end();) {
    const auto end = std::find_if(begin, areas.end(), [&](const SlippedArea& a) { return a.slip != begin->slip; });
    std::sort(begin, end, [](const SlippedArea& a, const SlippedArea& b) { return a.area < b.area; });
    begin = end;
  }
}

/// A chain or domain has fewer residues, so that one loop weighs more.
constexpr double kMostSlippedPart = 0.15;
/// A smaller part is judged like a ligand: by its mean.
constexpr std::size_t kLeastResidues = 10;
/// Less surface than this says nothing about a ligand or an ion.
constexpr double kLeastJudgedArea_A2 = 5;
constexpr std::size_t kMostNamed = 3;

/// A chain, a rigid domain or a ligand.
struct Part {
  std::string name;
  std::size_t n_residues = 0;
  double area = 0, slip = 0, large = 0;

  void add(const ResidueRow& row) {
    ++n_residues;
    if (!(row.matched_area_A2 > 0) || !std::isfinite(row.mean_slip_A)) return;
    area += row.matched_area_A2;
    slip += row.matched_area_A2 * row.mean_slip_A;
    large += row.matched_area_A2 * row.slip_area_fraction;
  }
};

/// "; most at ARG 72 of chain A (8.3 A)"
std::string most_at(const std::vector<std::string>& residues) {
  std::string names;
  for (std::size_t k = 0; k < std::min(kMostNamed, residues.size()); ++k) names += (k == 0 ? "" : ", ") + residues[k];
  return names.empty() ? names : "; most at " + names;
}

std::vector<Part> parts_of(const std::vector<ResidueRow>& rows, const std::vector<RigidDomain>& domains,
                           const Molecule& source, const std::vector<ResidueKind>& kinds) {
  std::map<std::string, Part> chains;
  std::vector<Part> parts;
  for (const ResidueRow& row : rows) {
    const Residue& residue = source.residues[row.residue];
    if (kinds[row.residue] == ResidueKind::kOther) {
      parts.push_back({residue_label(residue)});
      parts.back().add(row);
    } else if (kinds[row.residue] != ResidueKind::kWater) {
      Part& chain = chains[residue.chain];
      chain.name = residue.chain.empty() ? "the polymer" : "chain " + residue.chain;
      chain.add(row);
    }
  }
  if (chains.size() > 1) {
    for (const auto& [name, chain] : chains) parts.push_back(chain);
  }
  for (std::size_t k = 0; domains.size() > 1 && k < domains.size(); ++k) {
    Part domain{"domain " + std::to_string(k + 1)};
    for (const std::size_t r : domains[k].residues) domain.add(rows[r]);
    parts.push_back(domain);
  }
  return parts;
}

}  // namespace

SurfaceAreas surface_areas(const MappedSurface& s) {
  SurfaceAreas areas;
  areas.mapped.resize(s.triangles.size());
  if (!s.source_positions.empty()) areas.source.resize(s.triangles.size());
  const auto n = static_cast<std::ptrdiff_t>(s.triangles.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t triangle = 0; triangle < n; ++triangle) {
    const auto t = static_cast<std::size_t>(triangle);
    areas.mapped[t] = triangle_area(s.positions, s.triangles[t]);
    if (!areas.source.empty()) areas.source[t] = triangle_area(s.source_positions, s.triangles[t]);
  }
  return areas;
}

std::vector<double> matched_areas(const MappedSurface& s, const SurfaceAreas& areas) {
  std::vector<double> of_vertex(s.positions.size(), 0.0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.corrupt[t] != 0 || (!s.unmatched.empty() && s.unmatched[t] != 0)) continue;
    const double third = areas.mapped[t] / 3;
    for (const std::uint32_t c : s.triangles[t]) of_vertex[c] += third;
  }
  return of_vertex;
}

double share_outside(const MappedSurface& surface, const std::vector<double>& areas) {
  double all = 0, outside = 0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    all += areas[v];
    if (std::isnan(surface.potential_source[v]) || std::isnan(surface.potential_target[v])) outside += areas[v];
  }
  return all > 0 ? outside / all : 0;
}

SlipSummary summarize_slip(const MappedSurface& surface, const std::vector<double>& areas) {
  std::vector<SlippedArea> by_slip;
  double all = 0, known = 0, sum = 0;
  SlipSummary summary;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    all += areas[v];
    const double slip = static_cast<double>(surface.slip[v]);
    if (areas[v] <= 0 || std::isnan(slip)) continue;
    known += areas[v];
    sum += areas[v] * slip;
    if (slip > kMediumSlip_A) summary.medium_area_fraction += areas[v];
    if (slip > kLargeSlip_A) summary.large_area_fraction += areas[v];
    by_slip.push_back({surface.slip[v], areas[v]});
  }
  if (by_slip.empty()) return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, 1};
  summary.mean_A = sum / known;
  summary.medium_area_fraction /= known;
  summary.large_area_fraction /= known;
  summary.unpaired_area_fraction = 1 - known / all;
  sort_by_slip(by_slip);
  const auto quantile = [&](double share) {
    double below = 0;
    for (const auto& [slip, area] : by_slip) {
      below += area;
      if (below >= share * known) return static_cast<double>(slip);
    }
    return static_cast<double>(by_slip.back().slip);
  };
  summary.median_A = quantile(0.5);
  summary.p95_A = quantile(0.95);
  summary.max_A = static_cast<double>(by_slip.back().slip);
  return summary;
}

std::vector<std::string> slipped_residues(const std::vector<ResidueRow>& rows, const Molecule& source) {
  std::vector<const ResidueRow*> slipped;
  for (const ResidueRow& row : rows) {
    if (row.matched_area_A2 >= kLeastJudgedArea_A2 && row.mean_slip_A > kLargeSlip_A) slipped.push_back(&row);
  }
  std::stable_sort(slipped.begin(), slipped.end(),
                   [](const ResidueRow* a, const ResidueRow* b) { return a->mean_slip_A > b->mean_slip_A; });
  std::vector<std::string> names;
  names.reserve(slipped.size());
  for (const ResidueRow* row : slipped)
    names.push_back(residue_label(source.residues[row->residue]) + " (" + angstrom(row->mean_slip_A) + ")");
  return names;
}

std::vector<Message> slip_reasons(const std::optional<SlipSummary>& slip, const std::vector<ResidueRow>& rows,
                                  const std::vector<RigidDomain>& domains, bool follows_local, const Molecule& source) {
  std::vector<Message> reasons;
  if (!slip) return reasons;
  const double most_slipped = follows_local ? kMostSlippedAreaOfLocalMotions : kMostSlippedArea;
  const double large = slip->large_area_fraction;
  const std::string beyond = " slipped by more than " + angstrom(kLargeSlip_A) + " from its own atoms (limit ";
  if (large > most_slipped)
    reasons.emplace_back(percent(large) + " of the mapped area" + beyond + percent(most_slipped) + ")" +
                         most_at(slipped_residues(rows, source)));
  for (const Part& part : parts_of(rows, domains, source, residue_kinds(source, atoms_of_residues(source)))) {
    if (part.area < kLeastJudgedArea_A2) continue;
    if (part.n_residues >= kLeastResidues && part.large > kMostSlippedPart * part.area) {
      reasons.emplace_back(percent(part.large / part.area) + " of the mapped area of " + part.name + beyond +
                           percent(kMostSlippedPart) + ")");
    } else if (part.n_residues < kLeastResidues && part.slip > kLargeSlip_A * part.area) {
      reasons.emplace_back("the surface of " + part.name + " slipped by " + angstrom(part.slip / part.area) +
                           " from its own atoms on average (limit " + angstrom(kLargeSlip_A) + ")");
    }
  }
  return reasons;
}

}  // namespace espdiff
