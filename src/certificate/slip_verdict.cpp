// slip_verdict.cpp: the limits of the slip, over the whole area and by its parts.
#include <algorithm>
#include <cmath>
#include <map>

#include "align/geometry/rigid_domains.h"
#include "align/residue_names.h"
#include "base/molecule/residue_label.h"
#include "base/text/short_numbers.h"
#include "certificate/slip.h"

namespace espdiff {
namespace {

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
