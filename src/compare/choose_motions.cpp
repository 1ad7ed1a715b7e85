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

std::vector<Message> mapping_reasons(const CompareResult& result, const Molecule& source) {
  std::vector<Message> reasons = fit_reasons(result.certificate);
  for (const std::vector<Message>& more : {unmatched_reasons(result.certificate), slip_reasons(result, source)})
    reasons.insert(reasons.end(), more.begin(), more.end());
  return reasons;
}

OtherMapping described(const CompareResult& result, const Molecule& source, const char* because) {
  const Certificate& c = result.certificate;
  OtherMapping other;
  other.because = because;
  other.domains = result.domains_used;
  other.reasons = mapping_reasons(result, source);
  other.slip_area_fraction = c.slip ? c.slip->large_area_fraction : 0;
  other.same_residue_area_fraction = c.same_residue_area_fraction;
  other.unmatched_source = c.unmatched_source;
  other.unmatched_target = c.unmatched_target;
  other.own_residue_area_fraction = own_residue_share(result);
  return other;
}

MappedStep keep(MappedStep kept, const MappedStep& other, const Molecule& source, const char* because) {
  kept.result.other_mapping = described(other.result, source, because);
  return kept;
}

}  // namespace

bool slips(const CompareResult& result, const Molecule& source) { return !slip_reasons(result, source).empty(); }

bool will_slip(const Molecule& source, const Molecule& target, const AtomPairing& pairing, const CommonFrame& frame) {
  // Atoms that fade need 24 steps anyway: where the farthest one needs no more than about 45, long steps save little.
  constexpr double kFar_A = 10, kShare = 0.01, kFarthest_A = 16;
  std::size_t n_far = 0;
  double farthest = 0;
  for (const auto& [s, t] : pairing.pairs) {
    const Vec3d way = frame.from_target.apply(target.positions[t]) - frame.from_source.apply(source.positions[s]);
    const double length = norm(way);
    n_far += length > kFar_A ? 1 : 0;
    farthest = std::max(farthest, length);
  }
  return farthest > kFarthest_A && static_cast<double>(n_far) > kShare * static_cast<double>(pairing.pairs.size());
}

double own_residue_share(const CompareResult& result) {
  const Certificate& c = result.certificate;
  const double of_source = result.source_surface.area_A2, of_target = result.target_surface.area_A2;
  const double matched = of_source * (1 - c.unmatched_source) + of_target * (1 - c.unmatched_target);
  return c.same_residue_area_fraction * matched / (of_source + of_target);
}

MappedStep without_second(MappedStep straight, const Message& error) {
  straight.result.other_mapping = {
      "the mapping by local motions failed", kLocalMotions, {error}, kNaN, kNaN, kNaN, kNaN, kNaN};
  return straight;
}

bool keeps_local(const MappedStep& straight, const MappedStep& local, const Molecule& source) {
  return mapping_reasons(local.result, source).empty() ||
         own_residue_share(local.result) > own_residue_share(straight.result);
}

MappedStep better_of(MappedStep straight, MappedStep local, const Molecule& source) {
  if (mapping_reasons(local.result, source).empty())
    return keep(std::move(local), straight, source,
                "the superposition of the whole slips, and local motions are within the limits");
  if (keeps_local(straight, local, source))
    return keep(std::move(local), straight, source,
                "neither is within the limits; with local motions more of the surfaces is on its own residue");
  return keep(std::move(straight), local, source,
              "neither is within the limits; with local motions no more of the surfaces is on its own residue");
}

}  // namespace espdiff
