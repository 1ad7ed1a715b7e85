// choose_motions.cpp: compares two mappings of one pair by their limits, then by the area on its own residue.
#include "compare/choose_motions.h"

#include <algorithm>
#include <utility>

#include "align/geometry/rigid_domains.h"
#include "base/not_a_number.h"
#include "certificate/certificate.h"
#include "certificate/slip.h"

namespace espdiff {
namespace {

std::vector<Message> reasons_of_slip(const MappedStep& step, const StatesToMap& states) {
  return slip_reasons(step.certificate.slip, step.rows, states.alignment.domains, step.report.domains == kLocalMotions,
                      states.source);
}

std::vector<Message> mapping_reasons(const MappedStep& step, const StatesToMap& states) {
  std::vector<Message> reasons = fit_reasons(step.certificate);
  for (const std::vector<Message>& more : {unmatched_reasons(step.certificate), reasons_of_slip(step, states)})
    reasons.insert(reasons.end(), more.begin(), more.end());
  return reasons;
}

double share_of(const MappedStep& step, const StatesToMap& states) {
  return own_residue_share(step.certificate, states.source_surface.summary.area_A2,
                           states.target_surface.summary.area_A2);
}

OtherMapping described(const MappedStep& step, const StatesToMap& states, const char* because) {
  const Certificate& c = step.certificate;
  OtherMapping other;
  other.because = because;
  other.domains = step.report.domains;
  other.reasons = mapping_reasons(step, states);
  other.slip_area_fraction = c.slip ? c.slip->large_area_fraction : 0;
  other.same_residue_area_fraction = c.same_residue_area_fraction;
  other.unmatched_source = c.unmatched_source;
  other.unmatched_target = c.unmatched_target;
  other.own_residue_area_fraction = share_of(step, states);
  return other;
}

MappedStep keep(MappedStep kept, const MappedStep& other, const StatesToMap& states, const char* because) {
  kept.report.other = described(other, states, because);
  return kept;
}

}  // namespace

bool slips(const MappedStep& step, const StatesToMap& states) { return !reasons_of_slip(step, states).empty(); }

bool will_slip(const StatesToMap& states, const CommonFrame& frame) {
  // Atoms that fade need 16 steps anyway: where the farthest one needs no more than about 45, long steps save little.
  constexpr double kFar_A = 10, kShare = 0.01, kFarthest_A = 16;
  const auto& pairs = states.alignment.pairing.pairs;
  std::size_t n_far = 0;
  double farthest = 0;
  for (const auto& [s, t] : pairs) {
    const Vec3d way =
        frame.from_target.apply(states.target.positions[t]) - frame.from_source.apply(states.source.positions[s]);
    const double length = norm(way);
    n_far += length > kFar_A ? 1 : 0;
    farthest = std::max(farthest, length);
  }
  return farthest > kFarthest_A && static_cast<double>(n_far) > kShare * static_cast<double>(pairs.size());
}

double own_residue_share(const Certificate& c, double source_area, double target_area) {
  const double matched = source_area * (1 - c.unmatched_source) + target_area * (1 - c.unmatched_target);
  return c.same_residue_area_fraction * matched / (source_area + target_area);
}

MappedStep without_second(MappedStep straight, const Message& error) {
  straight.report.other = {"the mapping by local motions failed", kLocalMotions, {error}, kNaN, kNaN, kNaN, kNaN, kNaN};
  return straight;
}

bool keeps_local(const MappedStep& straight, const MappedStep& local, const StatesToMap& states) {
  return mapping_reasons(local, states).empty() || share_of(local, states) > share_of(straight, states);
}

MappedStep better_of(MappedStep straight, MappedStep local, const StatesToMap& states) {
  if (mapping_reasons(local, states).empty())
    return keep(std::move(local), straight, states,
                "the superposition of the whole slips, and local motions are within the limits");
  if (keeps_local(straight, local, states))
    return keep(std::move(local), straight, states,
                "neither is within the limits; with local motions more of the surfaces is on its own residue");
  return keep(std::move(straight), local, states,
              "neither is within the limits; with local motions no more of the surfaces is on its own residue");
}

}  // namespace espdiff
