// atom_paths.cpp: paths of paired atoms, and anchors for unpaired ones.
#include "motions/atom_paths.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "align/geometry/nearest_point.h"
#include "align/paired_residues.h"
#include "base/error.h"
#include "motions/local_rotations.h"

namespace espdiff {
namespace {

/// One of the two molecules, and which of its atoms are paired.
struct Side {
  const Molecule& molecule;
  std::vector<bool> paired;
  std::vector<std::vector<std::size_t>> paired_of_residue;
  std::vector<std::size_t> all_paired;
  mutable std::optional<NearestPoint> nearest_paired{};  ///< of all; made when it is first asked for

  explicit Side(const Molecule& m) : molecule(m), paired(m.size(), false), paired_of_residue(m.residues.size()) {}

  void add(std::size_t atom) {
    paired[atom] = true;
    paired_of_residue[static_cast<std::size_t>(molecule.atoms[atom].residue)].push_back(atom);
    all_paired.push_back(atom);
  }

  std::size_t anchor(std::size_t atom) const {
    const auto& own = paired_of_residue[static_cast<std::size_t>(molecule.atoms[atom].residue)];
    if (own.empty()) return nearest_of_all(atom);
    std::size_t nearest = own.front();
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t candidate : own) {
      const Vec3d d = molecule.positions[candidate] - molecule.positions[atom];
      if (dot(d, d) >= least) continue;
      least = dot(d, d);
      nearest = candidate;
    }
    return nearest;
  }

  std::size_t nearest_of_all(std::size_t atom) const {
    if (!nearest_paired) {
      std::vector<Vec3d> positions;
      for (const std::size_t paired_atom : all_paired) positions.push_back(molecule.positions[paired_atom]);
      nearest_paired.emplace(std::move(positions));
    }
    return all_paired[(*nearest_paired)(molecule.positions[atom])];
  }
};

/// Unpaired atoms of paired residues, such as the side chains of a substitution, pair with the nearest such atom within
/// this distance.
constexpr double kNearestPartner_A = 2.5;

/// Atoms farther than this from their anchor do not grow out of it, such as a ligand that floats free.
constexpr double kSproutReach_A = 8;

bool is_hydrogen(const Atom& atom) { return atom.element == "H" || atom.element == "D"; }

/// Pairs unpaired atoms of paired residues: nearest first, hydrogens with hydrogens only.
std::vector<std::pair<std::size_t, std::size_t>> pair_leftovers(const Side& from, const Side& to,
                                                                const std::vector<std::int32_t>& target_residue,
                                                                const RigidTransform& from_source,
                                                                const RigidTransform& from_target) {
  std::vector<std::vector<std::size_t>> left_over(to.molecule.residues.size());
  for (std::size_t t = 0; t < to.molecule.size(); ++t) {
    if (!to.paired[t]) left_over[static_cast<std::size_t>(to.molecule.atoms[t].residue)].push_back(t);
  }
  std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
  for (std::size_t s = 0; s < from.molecule.size(); ++s) {
    const std::int32_t residue = target_residue[static_cast<std::size_t>(from.molecule.atoms[s].residue)];
    if (from.paired[s] || residue < 0) continue;
    const Vec3d p = from_source.apply(from.molecule.positions[s]);
    for (const std::size_t t : left_over[static_cast<std::size_t>(residue)]) {
      if (is_hydrogen(from.molecule.atoms[s]) != is_hydrogen(to.molecule.atoms[t])) continue;
      const double distance = norm(from_target.apply(to.molecule.positions[t]) - p);
      if (distance <= kNearestPartner_A) candidates.emplace_back(distance, s, t);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> source_taken(from.molecule.size(), false), target_taken(to.molecule.size(), false);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [distance, s, t] : candidates) {
    if (source_taken[s] || target_taken[t]) continue;
    source_taken[s] = target_taken[t] = true;
    pairs.emplace_back(s, t);
  }
  return pairs;
}

}  // namespace

std::vector<MovingAtom> atom_paths(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                                   const RigidTransform& from_source, const RigidTransform& from_target,
                                   const DomainMotions& domains, double radius_scale, const Progress& progress) {
  if (pairing.pairs.empty())
    throw InputError("the morph needs paired atoms, and none pair; use " + option("method", "deform") +
                     ", which needs none");
  Side from(source), to(target);
  std::vector<std::size_t> target_of(source.size()), source_of(target.size());
  std::vector<std::int32_t> pair_of(source.size(), -1);
  std::int32_t n_pairs = 0;
  std::vector<std::pair<std::size_t, std::size_t>> pairs = pairing.pairs;
  const auto add_pairs = [&](const std::vector<std::pair<std::size_t, std::size_t>>& added) {
    for (const auto& [s, t] : added) {
      from.add(s);
      to.add(t);
      target_of[s] = t;
      source_of[t] = s;
      pair_of[s] = n_pairs++;
    }
  };
  add_pairs(pairs);
  const auto leftovers = pair_leftovers(from, to, paired_residues(source, target, pairing), from_source, from_target);
  add_pairs(leftovers);
  pairs.insert(pairs.end(), leftovers.begin(), leftovers.end());
  const auto width = [&](float radius) { return radius_scale * static_cast<double>(radius); };
  const auto motion_of = [&](std::size_t source_atom) { return domains.of(source.atoms[source_atom].residue); };
  std::vector<MovingAtom> paths;
  for (const auto& [s, t] : pairs) {
    MovingAtom path;
    path.pair = pair_of[s];
    path.motion = motion_of(s);
    path.start = from_source.apply(source.positions[s]);
    path.end = from_target.apply(target.positions[t]);
    path.start_width = width(source.radii[s]);
    path.end_width = width(target.radii[t]);
    path.at_start = path.start_width > 0;
    path.at_end = path.end_width > 0;
    if (!path.at_start) path.start_width = path.end_width;
    if (!path.at_end) path.end_width = path.start_width;
    if (path.at_start || path.at_end) paths.push_back(path);
  }
  for (std::size_t s = 0; s < source.size(); ++s) {
    if (from.paired[s] || !(source.radii[s] > 0)) continue;
    const std::size_t anchor = from.anchor(s);
    MovingAtom path;
    path.start = from_source.apply(source.positions[s]);
    path.end = from_target.apply(target.positions[target_of[anchor]]);
    const Vec3d arm = path.start - from_source.apply(source.positions[anchor]);
    path.motion = motion_of(anchor);
    if (norm(arm) > kSproutReach_A) {
      path.end += path.motion.turn(arm, 1);
    } else {
      path.pair = pair_of[anchor];
    }
    path.start_width = path.end_width = width(source.radii[s]);
    path.at_end = false;
    paths.push_back(path);
  }
  for (std::size_t t = 0; t < target.size(); ++t) {
    if (to.paired[t] || !(target.radii[t] > 0)) continue;
    const std::size_t anchor = to.anchor(t);
    MovingAtom path;
    path.start = from_source.apply(source.positions[source_of[anchor]]);
    path.end = from_target.apply(target.positions[t]);
    const Vec3d arm = path.end - from_target.apply(target.positions[anchor]);
    path.motion = motion_of(source_of[anchor]);
    if (norm(arm) > kSproutReach_A) {
      path.start += path.motion.turn(arm, -1);
    } else {
      path.pair = pair_of[source_of[anchor]];
    }
    path.start_width = path.end_width = width(target.radii[t]);
    path.at_start = false;
    paths.push_back(path);
  }
  set_local_rotations(paths, progress);
  return paths;
}

}  // namespace espdiff
