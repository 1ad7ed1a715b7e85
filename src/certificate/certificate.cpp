// certificate.cpp: the limits of a trustworthy mapping, and the reasons given when they are exceeded.
#include "certificate/certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/formatted.h"
#include "base/molecule/residue_label.h"
#include "base/not_a_number.h"
#include "base/text/short_numbers.h"
#include "certificate/own_potentials.h"
#include "certificate/slip.h"
#include "engine/engine.h"

namespace espdiff {
namespace {

/// The limits of a trustworthy result.
struct Limits {
  static constexpr double kCorruptArea = 1e-3;
  static constexpr double kFlippedArea = 0.0;
  static constexpr double kMeanDistance_A = 0.05;
  static constexpr double kRoundTrip_A = 0.1;
  /// Of either surface: what only one state has is new in one direction and lost in the other.
  static constexpr double kMaxUnmatched = 0.1;
  static constexpr std::size_t kSelfIntersectingPairs = 0;
  static constexpr double kResidueCorrelation = 0.93;
  /// Where the differences by residue err by less than this share of the potentials, they are noise: after smooth
  /// motions that the mapping followed everywhere, they err by 5 to 8 %.
  static constexpr double kResidueNoise = 0.1;
};

/// "3 pairs of triangles intersect (limit 0)"
std::string intersecting_pairs(std::size_t n) {
  return std::to_string(n) + (n == 1 ? " pair of triangles intersects" : " pairs of triangles intersect") + " (limit " +
         std::to_string(Limits::kSelfIntersectingPairs) + ")";
}

bool disagrees(const std::optional<ResidueCheck>& check) {
  return check && check->correlation < Limits::kResidueCorrelation &&
         check->rms_error > Limits::kResidueNoise * check->rms_potential;
}

/// "; most by ASN 248 of chain B (6.5 kT/e)"
std::string most_disagreeing_residues(const MeasuredSurface& result, const Molecule& source) {
  constexpr std::size_t kMostNamed = 3;
  std::string names;
  const std::vector<const ResidueRow*> rows = most_disagreeing(result.residues);
  for (std::size_t k = 0; k < std::min(kMostNamed, rows.size()); ++k)
    names += (k == 0 ? "; most by " : ", ") + residue_label(source.residues[rows[k]->residue]) + " (" +
             short_number(std::fabs(rows[k]->mean_signed_difference - rows[k]->own_difference)) + " " +
             to_string(result.potential.unit) + ")";
  return names;
}

/// By the source's area, since removed triangles have no place on the target.
RemovedArea removed_area(Engine& engine, const Mapping& mapping) {
  RemovedArea removed;
  if (mapping.removed_for.empty()) return removed;
  const Mesh source = engine.download_shape(mapping.source);
  double by_reason[7] = {}, all = 0;
  for (std::size_t t = 0; t < source.triangles.size(); ++t) {
    const Triangle& v = source.triangles[t];
    const Vec3f &a = source.positions[v[0]], &b = source.positions[v[1]], &c = source.positions[v[2]];
    const double area = 0.5 * static_cast<double>(norm(cross(b - a, c - a)));
    by_reason[static_cast<std::size_t>(mapping.removed_for[t])] += area;
    all += area;
  }
  const auto share = [&](Removal reason) { return by_reason[static_cast<std::size_t>(reason)] / all; };
  removed.torn = share(Removal::kTorn);
  removed.intersecting = share(Removal::kIntersecting);
  removed.flipped = share(Removal::kFlipped);
  removed.corrupt = share(Removal::kCorrupt);
  removed.far = share(Removal::kFar);
  removed.grown = share(Removal::kGrown);
  return removed;
}

}  // namespace

Certificate certify(Engine& engine, const Mapping& mapping, const MeshPtr& target, const MeshPtr& reached) {
  const DistanceSummary nothing{kNaN, kNaN, kNaN, kNaN, kNaN, nullptr};
  Certificate c;
  c.target_to_mapped = nothing;
  c.unmatched_target = target != nullptr ? 1 : kNaN;
  if (mapping.matched == nullptr) {
    c.corrupt_area_fraction = c.flipped_area_fraction = c.irregularity_A = kNaN;
    c.mapped_to_target = nothing;
    c.distortion = {kNaN, kNaN, kNaN, kNaN, kNaN, nullptr};
    c.unmatched_source = mapping.source != nullptr ? 1 : kNaN;
    return c;
  }
  c.corrupt_area_fraction = mapping.fit.corrupt_area_fraction;
  c.flipped_area_fraction = mapping.fit.flipped_area_fraction;
  c.irregularity_A = mapping.fit.irregularity_A;
  c.mapped_to_target = numbers_of(mapping.to_target);
  c.distortion = mapping.distortion;
  c.self_intersecting_pairs = mapping.intersections.n_pairs;
  const double kept = engine.area(mapping.matched_source) / engine.area(mapping.source);
  c.unmatched_source = 1 - kept * (1 - c.mapped_to_target.area_fraction_beyond_limit);
  if (target != nullptr) {
    c.target_to_mapped = numbers_of(engine.distances(target, reached, kMatchLimit_A));
    c.unmatched_target = c.target_to_mapped.area_fraction_beyond_limit;
  }
  c.removed = removed_area(engine, mapping);
  c.zero_by_construction = !mapping.removed_for.empty();
  return c;
}

double same_residue_share(const MappedSurface& s, const SurfaceAreas& areas,
                          const std::vector<std::int32_t>& source_residue,
                          const std::vector<std::int32_t>& target_residue, const std::vector<std::int32_t>& target_of) {
  double same = 0, all = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (!s.unmatched.empty() && s.unmatched[t] != 0) continue;
    const Triangle& v = s.triangles[t];
    const double third = areas.mapped[t] / 3;
    for (const std::uint32_t c : v) {
      if (source_residue[c] < 0 || target_of[static_cast<std::size_t>(source_residue[c])] < 0) continue;
      all += third;
      if (target_of[static_cast<std::size_t>(source_residue[c])] == target_residue[c]) same += third;
    }
  }
  return all > 0 ? same / all : std::numeric_limits<double>::quiet_NaN();
}

std::vector<Message> fit_reasons(const Certificate& c) {
  std::vector<Message> reasons;
  const auto refuse = [&](bool bad, const Message& reason) {
    if (bad) reasons.push_back(reason);
  };
  refuse(!c.converged, "the mapping did not converge; raise " + option("max-iterations"));
  refuse(c.corrupt_area_fraction > Limits::kCorruptArea, percent(c.corrupt_area_fraction) +
                                                             " of the mapped area is corrupt (limit " +
                                                             percent(Limits::kCorruptArea) + ")");
  refuse(c.flipped_area_fraction > Limits::kFlippedArea,
         percent(c.flipped_area_fraction) + " of the mapped area is flipped (limit 0 %)");
  refuse(c.self_intersecting_pairs > Limits::kSelfIntersectingPairs, intersecting_pairs(c.self_intersecting_pairs));
  refuse(c.mapped_to_target.mean_within_limit > Limits::kMeanDistance_A,
         "the mapped surface lies " + angstrom(c.mapped_to_target.mean_within_limit) +
             " from the target on average (limit " + angstrom(Limits::kMeanDistance_A) + ")");
  refuse(c.target_to_mapped.mean_within_limit > Limits::kMeanDistance_A,
         "the target lies " + angstrom(c.target_to_mapped.mean_within_limit) +
             " from the mapped surface on average (limit " + angstrom(Limits::kMeanDistance_A) + ")");
  return reasons;
}

std::vector<Message> unmatched_reasons(const Certificate& c) {
  std::vector<Message> reasons;
  const auto refuse = [&](bool bad, const Message& reason) {
    if (bad) reasons.push_back(reason);
  };
  refuse(c.unmatched_source > Limits::kMaxUnmatched,
         percent(c.unmatched_source) + " of the source's area is unmatched (limit " + percent(Limits::kMaxUnmatched) +
             ")" +
             (c.unmatched_target > Limits::kMaxUnmatched
                  ? ""
                  : "; exchange source and target: what closes on the way cannot be followed, what opens can"));
  refuse(c.unmatched_target > Limits::kMaxUnmatched, percent(c.unmatched_target) +
                                                         " of the target's area is unmatched (limit " +
                                                         percent(Limits::kMaxUnmatched) + ")");
  return reasons;
}

/// "30 % is unmatched, 8 % slipped": the shares of the source that are not trusted, without the smallest.
std::string shares_not_trusted(const TrustedArea& trusted) {
  constexpr double kLeastNamed = 0.01;
  static constexpr const char* kWords[kNumberOfWhys] = {
      "",        "unmatched",          "not on the target's surface", "without a partner",
      "slipped", "on another residue", "of residues that disagree",   "without a potential",
      "turned"};
  std::string text;
  for (std::size_t k = 1; k < kNumberOfWhys; ++k) {
    if (trusted.by_why[k] >= kLeastNamed)
      text += (text.empty() ? "" : ", ") + percent(trusted.by_why[k]) + " " + kWords[k];
  }
  return text.empty() ? text : "; of the source " + text;
}

void judge(MeasuredSurface& surface, const std::vector<Warning>& warnings, const Molecule& source,
           double required_share) {
  Certificate& c = surface.certificate;
  for (const Warning& warning : warnings) {
    if (warning.refuses) c.reasons.push_back(warning.text);
  }
  const auto refuse_all = [&](const std::vector<Message>& reasons) {
    c.reasons.insert(c.reasons.end(), reasons.begin(), reasons.end());
  };
  const auto refuse = [&](bool bad, const Message& reason) {
    if (bad) c.reasons.push_back(reason);
  };
  refuse_all(fit_reasons(c));
  refuse(c.round_trip && c.round_trip->mean_A > Limits::kRoundTrip_A,
         "the round-trip error is " + angstrom(c.round_trip ? c.round_trip->mean_A : 0) + " on average (limit " +
             angstrom(Limits::kRoundTrip_A) + ")");
  refuse(disagrees(c.residues),
         "the differences by residue correlate by " +
             number_beside(c.residues ? c.residues->correlation : 0, Limits::kResidueCorrelation, 2) +
             " with those of each residue's potentials on its own surfaces (limit " +
             formatted("%.2f", Limits::kResidueCorrelation) + ")" +
             (disagrees(c.residues) ? most_disagreeing_residues(surface, source) : ""));
  refuse(!(c.trusted.share() >= required_share),
         percent(c.trusted.source) + " of the source's surface and " + percent(c.trusted.target) +
             " of the target's are trusted (limit " + percent(required_share) + ")" + shares_not_trusted(c.trusted));
  c.trustworthy = c.reasons.empty();
}

}  // namespace espdiff
