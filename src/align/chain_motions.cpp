// chain_motions.cpp: superposes each chain, and the others without it.
#include "align/chain_motions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "align/superpose.h"
#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {
namespace {

using AtomPairs = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr std::size_t kLeastChain = 20, kMostNamedChains = 4;

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

ChainMotion motion_of_chain(const Molecule& source, const Molecule& target, const AtomPairs& chain,
                            const AtomPairs& others) {
  const RigidTransform theirs = superpose(source.positions, target.positions, others).transform;
  const Superposition own = superpose(source.positions, target.positions, chain);
  ChainMotion motion;
  motion.own_rmsd_A = own.rmsd_A;
  Vec3d shift{};
  double squares = 0;
  for (const auto& [s, t] : chain) {
    const Vec3d off = target.positions[t] - theirs.apply(source.positions[s]);
    shift += off;
    squares += dot(off, off);
  }
  const double n = static_cast<double>(chain.size());
  motion.shift_A = norm((1 / n) * shift);
  motion.rmsd_A = std::sqrt(squares / n);
  motion.rotation_degrees = angle_of(compose(own.transform, inverse(theirs)));
  return motion;
}

}  // namespace

std::vector<ChainMotion> chain_motions(const Molecule& source, const Molecule& target, const AtomPairing& pairing) {
  const std::map<std::string, AtomPairs> chains = large_chains(source, pairing);
  std::vector<ChainMotion> motions;
  if (chains.size() < 2) return motions;
  for (const auto& [name, chain] : chains) {
    AtomPairs others;
    for (const auto& [other, of_other] : chains) {
      if (other != name) others.insert(others.end(), of_other.begin(), of_other.end());
    }
    try {
      motions.push_back(motion_of_chain(source, target, chain, others));
      motions.back().chain = name;
    } catch (const GeometryError&) {
      continue;
    }
  }
  return motions;
}

std::string in_words(std::vector<ChainMotion> motions) {
  std::stable_sort(motions.begin(), motions.end(),
                   [](const ChainMotion& a, const ChainMotion& b) { return a.rmsd_A > b.rmsd_A; });
  std::string text;
  for (std::size_t k = 0; k < std::min(kMostNamedChains, motions.size()); ++k)
    text += (k == 0 ? "" : ", ") + (motions[k].chain.empty() ? "(no name)" : motions[k].chain) +
            formatted(" by %.3g degrees and %.3g A", motions[k].rotation_degrees, motions[k].shift_A);
  if (motions.size() > kMostNamedChains)
    text += ", " + std::to_string(motions.size() - kMostNamedChains) + " others by less";
  return text;
}

}  // namespace espdiff
