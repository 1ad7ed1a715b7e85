// chain_motions.cpp: superposes each chain, and the largest group that moves as one.
#include "align/geometry/chain_motions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

using AtomPairs = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr std::size_t kLeastChain = 20, kMostNamedChains = 4;
/// A chain keeps its place beside another whose motion fits it by this, or by little more than its own.
constexpr double kTogether_A = 1, kTogetherShare = 1.5;

/// [chain of the source] its paired atoms, where enough residues have some.
std::map<std::string, AtomPairs> large_chains(const Molecule& source, const AtomPairing& pairing) {
  std::map<std::string, std::pair<AtomPairs, std::set<std::int32_t>>> chains;
  for (const auto& pair : pairing.pairs) {
    const std::int32_t residue = source.atoms[pair.first].residue;
    auto& [pairs, residues] = chains[source.residues[static_cast<std::size_t>(residue)].chain];
    pairs.push_back(pair);
    residues.insert(residue);
  }
  std::map<std::string, AtomPairs> large;
  for (auto& [name, chain] : chains) {
    if (chain.second.size() >= kLeastChain) large.emplace(name, std::move(chain.first));
  }
  return large;
}

/// The angle of a rotation, in degrees.
double angle_of(const RigidTransform& transform) { return std::fabs(screw_of(transform).angle) * 180 / kPi; }

/// A chain with its superposition by itself.
struct FittedChain {
  std::string name;
  AtomPairs pairs;
  Superposition own;
};

/// The RMSD of a chain's atoms under a motion, and the shift of their centre.
std::pair<double, double> misfit(const Molecule& source, const Molecule& target, const AtomPairs& pairs,
                                 const RigidTransform& motion) {
  Vec3d shift{};
  double squares = 0;
  for (const auto& [s, t] : pairs) {
    const Vec3d off = target.positions[t] - motion.apply(source.positions[s]);
    shift += off;
    squares += dot(off, off);
  }
  const double n = static_cast<double>(pairs.size());
  return {std::sqrt(squares / n), norm((1 / n) * shift)};
}

/// The atoms of the largest group of chains that one chain's motion fits, the first of several.
AtomPairs group_that_stays(const Molecule& source, const Molecule& target, const std::vector<FittedChain>& chains) {
  AtomPairs largest;
  for (const FittedChain& seed : chains) {
    AtomPairs group;
    for (const FittedChain& chain : chains) {
      const double most = std::max(kTogether_A, kTogetherShare * chain.own.rmsd_A);
      if (misfit(source, target, chain.pairs, seed.own.transform).first > most) continue;
      group.insert(group.end(), chain.pairs.begin(), chain.pairs.end());
    }
    if (group.size() > largest.size()) largest = std::move(group);
  }
  return largest;
}

}  // namespace

std::vector<ChainMotion> chain_motions(const Molecule& source, const Molecule& target, const AtomPairing& pairing) {
  std::vector<FittedChain> chains;
  for (auto& [name, pairs] : large_chains(source, pairing)) {
    try {
      const Superposition own = superpose(source.positions, target.positions, pairs);
      chains.push_back({name, pairs, own});
    } catch (const GeometryError&) {
      continue;  // on a line
    }
  }
  std::vector<ChainMotion> motions;
  if (chains.size() < 2) return motions;
  const RigidTransform rest =
      superpose(source.positions, target.positions, group_that_stays(source, target, chains)).transform;
  for (const FittedChain& chain : chains) {
    const auto [rmsd_A, shift_A] = misfit(source, target, chain.pairs, rest);
    motions.push_back(
        {chain.name, angle_of(compose(chain.own.transform, inverse(rest))), shift_A, rmsd_A, chain.own.rmsd_A});
  }
  return motions;
}

std::string in_words(std::vector<ChainMotion> motions) {
  std::stable_sort(motions.begin(), motions.end(),
                   [](const ChainMotion& a, const ChainMotion& b) { return a.rmsd_A > b.rmsd_A; });
  std::string text;
  for (std::size_t k = 0; k < std::min(kMostNamedChains, motions.size()); ++k)
    text += (k == 0 ? "" : ", ") + (motions[k].chain.empty() ? "(no name)" : motions[k].chain) +
            formatted(" by %.1f degrees and %.1f A", motions[k].rotation_degrees, motions[k].shift_A);
  if (motions.size() > kMostNamedChains)
    text += ", " + std::to_string(motions.size() - kMostNamedChains) + " others by less";
  return text;
}

}  // namespace espdiff
