// choose_motions.cpp: compares two mappings of one pair by their limits, then by the area on its own residue.
#include "compare/choose_motions.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

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

/// Where the paired atoms of a residue start and end.
struct Surroundings {
  Vec3d start{}, end{};  ///< sums
  double n = 0;

  void add(const Vec3d& starts, const Vec3d& ends) {
    start += starts;
    end += ends;
    ++n;
  }
};

/// [residue] the mean way of the paired atoms of residues around it, itself among them: those whose centroids lie near
/// its own on the source and have not gone far from it on the target, as another domain's may.
std::vector<Vec3d> mean_ways_around(const std::vector<Surroundings>& residues) {
  constexpr double kNear_A = 12, kNearAtEnd_A = 18;
  std::vector<Vec3d> means(residues.size());
  const auto n = static_cast<std::ptrdiff_t>(residues.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const Surroundings& own = residues[static_cast<std::size_t>(i)];
    if (own.n == 0) continue;
    const Vec3d start = (1 / own.n) * own.start, end = (1 / own.n) * own.end;
    Surroundings near;
    for (const Surroundings& other : residues) {
      if (other.n == 0 || norm((1 / other.n) * other.start - start) > kNear_A ||
          norm((1 / other.n) * other.end - end) > kNearAtEnd_A)
        continue;
      near.start += other.start;
      near.end += other.end;
      near.n += other.n;
    }
    means[static_cast<std::size_t>(i)] = (1 / near.n) * (near.end - near.start);
  }
  return means;
}

}  // namespace

bool slips(const MappedStep& step, const StatesToMap& states) { return !reasons_of_slip(step, states).empty(); }

bool slips_clearly(const MappedStep& trial, const StatesToMap& states) {
  constexpr double kOfSteps = 0.01;  // of 347 pairs 0.007 at most
  return slips(trial, states) && trial.certificate.slip->large_area_fraction > kMostSlippedArea + kOfSteps;
}

bool will_slip(const StatesToMap& states, const CommonFrame& frame) {
  constexpr double kFar_A = 9, kShare = 0.012;
  const auto& pairs = states.alignment.pairing.pairs;
  std::vector<Vec3d> ways;
  double longest_A = 0;
  std::vector<Surroundings> residues(states.source.residues.size());
  for (const auto& [s, t] : pairs) {
    const Vec3d start = frame.from_source.apply(states.source.positions[s]),
                end = frame.from_target.apply(states.target.positions[t]);
    ways.push_back(end - start);
    longest_A = std::max(longest_A, norm(ways.back()));
    residues[static_cast<std::size_t>(states.source.atoms[s].residue)].add(start, end);
  }
  if (longest_A < kFar_A / 2) return false;  // two ways that short do not end so far apart
  const std::vector<Vec3d> around = mean_ways_around(residues);
  std::size_t n_far = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto residue = static_cast<std::size_t>(states.source.atoms[pairs[i].first].residue);
    n_far += norm(ways[i] - around[residue]) > kFar_A ? 1 : 0;
  }
  return static_cast<double>(n_far) > kShare * static_cast<double>(pairs.size());
}

double own_residue_share(const Certificate& c, double source_area, double target_area) {
  const double matched = source_area * (1 - c.unmatched_source) + target_area * (1 - c.unmatched_target);
  return c.same_residue_area_fraction * matched / (source_area + target_area);
}

MappedStep without_second(MappedStep straight, const Message& error) {
  straight.report.other = {"the mapping by local motions failed", kLocalMotions, {error}, kNaN, kNaN, kNaN, kNaN, kNaN};
  return straight;
}

bool keeps_local_clearly(const MappedStep& trial, const MappedStep& local, const StatesToMap& states) {
  constexpr double kOfSteps = 0.005;  // of 347 pairs 0.006 at most; none chooses otherwise
  return mapping_reasons(local, states).empty() || share_of(local, states) > share_of(trial, states) + kOfSteps;
}

MappedStep better_of(MappedStep straight, MappedStep local, const StatesToMap& states) {
  if (mapping_reasons(local, states).empty())
    return keep(std::move(local), straight, states,
                "the superposition of the whole slips, and local motions are within the limits");
  if (share_of(local, states) > share_of(straight, states))
    return keep(std::move(local), straight, states,
                "neither is within the limits; with local motions more of the surfaces is on its own residue");
  return keep(std::move(straight), local, states,
              "neither is within the limits; with local motions no more of the surfaces is on its own residue");
}

}  // namespace espdiff
