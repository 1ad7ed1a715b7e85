// register_warning.cpp: finds pairs of residues that are shifted along the chain, of the whole and of stretches.
#include "input_checks/register_warning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "align/geometry/nearest_point.h"
#include "base/molecule/residue_label.h"
#include "base/text/short_numbers.h"
#include "input_checks/surroundings.h"

namespace espdiff {
namespace {

/// A residue lies on another one if their C-alpha or P atoms are nearer than this: half the distance of neighbours.
constexpr double kLiesOnAnother_A = 1.9;
/// A chance arrangement puts a few percent of the residues on others at any one shift.
constexpr double kMostShifted = 0.2;
/// Of a stretch of eight residues the best six count, so that it may begin and end beside the shifted part.
constexpr std::size_t kStretch = 8, kCounted = 6;
constexpr std::ptrdiff_t kFarthestShift = 4;
/// A stretch off its partners by more than this, and by much less off others, is shifted. A helix turned by 100 degrees
/// is off by 3.5 A, and by 1.5 A from the next residues.
constexpr double kOffPartners_A = 2.5, kCloserShare = 0.6;
constexpr std::size_t kMostStretchesNamed = 3;

/// A residue's place in its chain.
using ChainPlace = std::pair<std::size_t, std::ptrdiff_t>;

std::vector<ChainPlace> chain_places(const ChainLinks& links) {
  std::vector<ChainPlace> places(links.next.size());
  for (std::size_t c = 0; c < links.chains.size(); ++c) {
    for (std::size_t k = 0; k < links.chains[c].size(); ++k)
      places[links.chains[c][k]] = {c, static_cast<std::ptrdiff_t>(k)};
  }
  return places;
}

const Vec3d& trace_place(const ResidueView& view, std::size_t residue) {
  return view.molecule->positions[static_cast<std::size_t>(trace_atom(view, residue))];
}

std::string residues_away(std::ptrdiff_t shift) {
  return std::to_string(std::abs(shift)) + (shift > 0 ? " after" : " before");
}

/// Whether many residues of the whole, superposed as it is, lie on others that are shifted alike.
bool check_whole_register(const PairedMolecules& pair, const RigidTransform& motion, std::vector<Warning>& warnings) {
  std::vector<std::size_t> residues;
  std::vector<Vec3d> places;
  for (std::size_t t = 0; t < pair.target.kinds.size(); ++t) {
    if (trace_atom(pair.target, t) < 0) continue;
    residues.push_back(t);
    places.push_back(trace_place(pair.target, t));
  }
  if (places.empty()) return false;
  const std::vector<ChainPlace> in_chain = chain_places(pair.target_links);
  const NearestPoint nearest(places);
  std::map<std::ptrdiff_t, std::size_t> votes;
  std::size_t n = 0;
  for (std::size_t s = 0; s < pair.target_of.size(); ++s) {
    if (pair.target_of[s] < 0 || trace_atom(pair.source, s) < 0) continue;
    ++n;
    const Vec3d p = motion.apply(trace_place(pair.source, s));
    const std::size_t there = nearest(p);
    const ChainPlace own = in_chain[static_cast<std::size_t>(pair.target_of[s])], other = in_chain[residues[there]];
    if (own == other || own.first != other.first || norm(places[there] - p) > kLiesOnAnother_A) continue;
    ++votes[other.second - own.second];
  }
  std::pair<std::size_t, std::ptrdiff_t> most{0, 0};
  for (const auto& [shift, count] : votes) most = count > most.first ? std::pair(count, shift) : most;
  if (n == 0 || static_cast<double>(most.first) <= kMostShifted * static_cast<double>(n)) return false;
  warnings.push_back({std::to_string(most.first) + " of " + std::to_string(n) + " residues lie on the residue " +
                          residues_away(most.second) +
                          " their partner in the chain: the alignment or the numbering is shifted",
                      true});
  return true;
}

/// The root of the mean square of the `counted` least of the distances.
double rms_of_least(std::array<double, kStretch> distances, std::size_t counted) {
  std::sort(distances.begin(), distances.end());
  double sum = 0;
  for (std::size_t k = 0; k < counted; ++k) sum += distances[k] * distances[k];
  return std::sqrt(sum / static_cast<double>(counted));
}

/// By how many residues a stretch lies beside its partners; 0 if it does not, or if nothing says where it belongs.
/// @param first of the stretch, in the source's chain
std::ptrdiff_t shift_of_stretch(const PairedMolecules& pair, const std::vector<ChainPlace>& in_target,
                                const std::vector<std::size_t>& chain, std::size_t first) {
  const auto& motion = pair.motions[chain[first + kStretch / 2]];
  if (!motion) return 0;
  std::array<Vec3d, kStretch> expected;
  std::array<ChainPlace, kStretch> partners;
  for (std::size_t k = 0; k < kStretch; ++k) {
    const std::size_t s = chain[first + k];
    if (pair.target_of[s] < 0 || trace_atom(pair.source, s) < 0) return 0;
    expected[k] = motion->apply(trace_place(pair.source, s));
    partners[k] = in_target[static_cast<std::size_t>(pair.target_of[s])];
    if (partners[k].first != partners[0].first) return 0;
  }
  const std::vector<std::size_t>& targets = pair.target_links.chains[partners[0].first];
  const auto off = [&](std::ptrdiff_t shift, std::size_t counted) {
    std::array<double, kStretch> distances;
    for (std::size_t k = 0; k < kStretch; ++k) {
      const std::ptrdiff_t there = partners[k].second + shift;
      const bool exists = there >= 0 && there < static_cast<std::ptrdiff_t>(targets.size()) &&
                          trace_atom(pair.target, targets[static_cast<std::size_t>(there)]) >= 0;
      distances[k] =
          exists ? norm(expected[k] - trace_place(pair.target, targets[static_cast<std::size_t>(there)])) : INFINITY;
    }
    return rms_of_least(distances, counted);
  };
  const double own = off(0, kCounted);
  if (own < kOffPartners_A) return 0;
  std::pair<double, std::ptrdiff_t> best{std::min(kLiesOnAnother_A, kCloserShare * own), 0};
  for (std::ptrdiff_t shift = -kFarthestShift; shift <= kFarthestShift; ++shift) {
    if (shift != 0) best = std::min(best, {off(shift, kCounted), shift});
  }
  return best.second;
}

}  // namespace

void check_register(const PairedMolecules& pair, const Alignment& alignment, std::vector<Warning>& warnings) {
  if (check_whole_register(pair, alignment.source_to_target, warnings)) return;
  const std::vector<ChainPlace> in_target = chain_places(pair.target_links);
  const Molecule& molecule = *pair.source.molecule;
  std::size_t n = 0;
  std::string names;
  for (const std::vector<std::size_t>& chain : pair.source_links.chains) {
    for (std::size_t first = 0; first + kStretch <= chain.size();) {
      const std::ptrdiff_t shift = shift_of_stretch(pair, in_target, chain, first);
      if (shift == 0) {
        ++first;
        continue;
      }
      std::size_t last = first;
      while (last + 1 + kStretch <= chain.size() && shift_of_stretch(pair, in_target, chain, last + 1) == shift) ++last;
      if (++n <= kMostStretchesNamed)
        names += (names.empty() ? "" : "; ") + residue_label(molecule.residues[chain[first]]) + " to " +
                 residue_label(molecule.residues[chain[last + kStretch - 1]]) + ", " + residues_away(shift);
      first = last + kStretch;
    }
  }
  if (n == 0) return;
  warnings.push_back({std::to_string(n) + (n == 1 ? " stretch of residues lies" : " stretches of residues lie") +
                          " on others than their partners in the chain (" + names +
                          (n > kMostStretchesNamed ? "; ..." : "") + "): the alignment or one model is shifted there",
                      true});
}

}  // namespace espdiff
