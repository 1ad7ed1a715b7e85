// broken_chains.cpp: finds neighbours of a chain that no chain can span.
#include "input_checks/broken_chains.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "base/molecule/residue_label.h"
#include "base/text/short_numbers.h"
#include "input_checks/surroundings.h"

namespace espdiff {
namespace {

/// C-alpha atoms of neighbouring residues are 3.8 A apart (2.9 A if cis), P atoms at most 7.5 A.
constexpr double kStepAminoAcid_A = 3.9, kStepNucleotide_A = 7.5, kSlack_A = 2.5;
/// What both states lack alike may be a loop without residue numbers, or the way to another chain of the same name. It
/// spans at most as much as this number of residues, and about as much in both.
constexpr double kMostMissing = 10, kAlike_A = 8;
constexpr std::int64_t kMostCounted = 100;

struct ChainBreak {
  std::size_t before, after;
  double distance_A;
  bool spannable;  ///< by a loop that could be missing
};

/// How many residues the other state has from one residue to the other; 0 if they are not of one chain there.
std::int64_t steps_in_other(std::int32_t from, std::int32_t to, const ChainLinks& links) {
  if (from < 0 || to < 0) return 0;
  for (std::int64_t n = 1; n <= kMostCounted && from >= 0; ++n) {
    from = links.next[static_cast<std::size_t>(from)];
    if (from == to) return n;
  }
  return 0;
}

/// The break after a residue, if there is one.
/// @param partner_of [residue] in the other state  @param other its links
std::optional<ChainBreak> break_after(const ResidueView& view, const ChainLinks& links, std::size_t residue,
                                      const std::vector<std::int32_t>& partner_of, const ChainLinks& other) {
  if (links.next[residue] < 0) return std::nullopt;
  const auto after = static_cast<std::size_t>(links.next[residue]);
  const std::ptrdiff_t a = trace_atom(view, residue), b = trace_atom(view, after);
  if (a < 0 || b < 0) return std::nullopt;
  const Residue &from = view.molecule->residues[residue], &to = view.molecule->residues[after];
  const std::int64_t by_number = std::int64_t{to.number} - std::int64_t{from.number};
  const std::int64_t steps =
      std::max({std::int64_t{1}, by_number, by_number == 0 ? std::int64_t{to.insertion_code} - from.insertion_code : 0,
                steps_in_other(partner_of[residue], partner_of[after], other)});
  const double step_A = view.kinds[residue] == ResidueKind::kAminoAcid ? kStepAminoAcid_A : kStepNucleotide_A;
  const double distance = norm(view.molecule->positions[static_cast<std::size_t>(b)] -
                               view.molecule->positions[static_cast<std::size_t>(a)]);
  if (distance <= step_A * static_cast<double>(steps) + kSlack_A) return std::nullopt;
  return ChainBreak{residue, after, distance, distance <= step_A * kMostMissing};
}

/// Examples of breaks, at most two: "LYS 19 of chain A and ASP 20 of chain A (58.8 A)".
std::string examples_of(const ResidueView& view, const std::vector<ChainBreak>& breaks) {
  std::string examples;
  for (std::size_t k = 0; k < std::min<std::size_t>(2, breaks.size()); ++k)
    examples += (k == 0 ? "" : ", ") + residue_label(view.molecule->residues[breaks[k].before]) + " and " +
                residue_label(view.molecule->residues[breaks[k].after]) + " (" + short_number(breaks[k].distance_A) +
                " A)";
  return examples;
}

std::string in_places(std::size_t n) { return std::to_string(n) + (n == 1 ? " place" : " places"); }

/// One of the two molecules as the check sees it.
struct CheckedSide {
  const char* role;
  const ResidueView& view;
  const ChainLinks& links;
  const std::vector<std::int32_t>& partner_of;
};

/// @returns the breaks that the other molecule has alike
std::vector<ChainBreak> check_side(const CheckedSide& side, const CheckedSide& other, std::vector<Warning>& warnings) {
  std::vector<ChainBreak> alike, own;
  for (std::size_t r = 0; r < side.view.kinds.size(); ++r) {
    const auto found = break_after(side.view, side.links, r, side.partner_of, other.links);
    if (!found) continue;
    const std::int32_t a = side.partner_of[found->before], b = side.partner_of[found->after];
    const bool linked = a >= 0 && b >= 0 && other.links.next[static_cast<std::size_t>(a)] == b;
    const auto there =
        linked ? break_after(other.view, other.links, static_cast<std::size_t>(a), other.partner_of, side.links)
               : std::nullopt;
    const bool is_alike = there && found->spannable && std::fabs(there->distance_A - found->distance_A) <= kAlike_A;
    (is_alike ? alike : own).push_back(*found);
  }
  if (!own.empty())
    warnings.push_back(
        {std::string("the ") + side.role + " is broken in " + in_places(own.size()) +
             ", where neighbours lie farther apart than a chain reaches: " + examples_of(side.view, own) +
             "; if it crosses the border of a periodic cell, make it whole first",
         true});
  return alike;
}

}  // namespace

void check_chains(const PairedMolecules& pair, std::vector<Warning>& warnings) {
  const CheckedSide source{"source", pair.source, pair.source_links, pair.target_of},
      target{"target", pair.target, pair.target_links, pair.source_of};
  const std::vector<ChainBreak> alike = check_side(source, target, warnings);
  check_side(target, source, warnings);
  if (alike.empty()) return;
  warnings.push_back({"source and target are broken alike in " + in_places(alike.size()) +
                          ", where neighbours lie farther apart than a chain reaches: " +
                          examples_of(pair.source, alike) + "; both lack the same residues, or two chains share a name",
                      false});
}

}  // namespace espdiff
