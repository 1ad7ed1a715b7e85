// atom_ways.cpp: pairs become ways, and what has no counterpart finds its anchor.
#include "pipeline/atom_ways.h"

#include <limits>

#include "base/error.h"

namespace espdiff {
namespace {

/// One of the two molecules, with which of its atoms are paired.
struct Side {
  const Molecule& molecule;
  std::vector<bool> paired;
  std::vector<std::vector<std::size_t>> paired_of_residue;
  std::vector<std::size_t> all_paired;

  explicit Side(const Molecule& m) : molecule(m), paired(m.size(), false), paired_of_residue(m.residues.size()) {}

  void add(std::size_t atom) {
    paired[atom] = true;
    paired_of_residue[static_cast<std::size_t>(molecule.atoms[atom].residue)].push_back(atom);
    all_paired.push_back(atom);
  }

  std::size_t anchor(std::size_t atom) const {
    const auto& own = paired_of_residue[static_cast<std::size_t>(molecule.atoms[atom].residue)];
    const auto& candidates = own.empty() ? all_paired : own;
    std::size_t nearest = candidates.front();
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t candidate : candidates) {
      const Vec3d d = molecule.positions[candidate] - molecule.positions[atom];
      if (dot(d, d) >= least) continue;
      least = dot(d, d);
      nearest = candidate;
    }
    return nearest;
  }
};

}  // namespace

std::vector<MovingAtom> atom_ways(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                                  const RigidTransform& from_source, const RigidTransform& from_target,
                                  double radius_scale) {
  if (pairing.pairs.empty())
    throw InputError("the morph follows paired atoms, and none pair; use --method deform, which needs none");
  Side from(source), to(target);
  std::vector<std::size_t> target_of(source.size()), source_of(target.size());
  for (const auto& [s, t] : pairing.pairs) {
    from.add(s);
    to.add(t);
    target_of[s] = t;
    source_of[t] = s;
  }
  const auto width = [&](float radius) { return radius_scale * static_cast<double>(radius); };
  std::vector<MovingAtom> ways;
  for (const auto& [s, t] : pairing.pairs) {
    MovingAtom way;
    way.start = from_source.apply(source.positions[s]);
    way.end = from_target.apply(target.positions[t]);
    way.start_width = width(source.radii[s]);
    way.end_width = width(target.radii[t]);
    way.at_start = way.start_width > 0;
    way.at_end = way.end_width > 0;
    if (!way.at_start) way.start_width = way.end_width;
    if (!way.at_end) way.end_width = way.start_width;
    if (way.at_start || way.at_end) ways.push_back(way);
  }
  for (std::size_t s = 0; s < source.size(); ++s) {
    if (from.paired[s] || !(source.radii[s] > 0)) continue;
    MovingAtom way;
    way.start = from_source.apply(source.positions[s]);
    way.end = from_target.apply(target.positions[target_of[from.anchor(s)]]);
    way.start_width = way.end_width = width(source.radii[s]);
    way.at_end = false;
    ways.push_back(way);
  }
  for (std::size_t t = 0; t < target.size(); ++t) {
    if (to.paired[t] || !(target.radii[t] > 0)) continue;
    MovingAtom way;
    way.start = from_source.apply(source.positions[source_of[to.anchor(t)]]);
    way.end = from_target.apply(target.positions[t]);
    way.start_width = way.end_width = width(target.radii[t]);
    way.at_start = false;
    ways.push_back(way);
  }
  return ways;
}

}  // namespace espdiff
