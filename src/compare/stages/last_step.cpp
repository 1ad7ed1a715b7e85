// last_step.cpp: continues a series from one target to the next.
#include "compare/stages/last_step.h"

#include <cmath>
#include <limits>
#include <utility>

#include "align/geometry/superpose.h"
#include "align/pair_atoms.h"
#include "align/paired_residues.h"
#include "base/error.h"
#include "base/not_a_number.h"
#include "engine/engine.h"
#include "motions/atom_paths.h"
#include "options/options.h"

namespace espdiff {
namespace {

/// For the morph: continuing inherits the losses, so it pays off for small steps only. Between models of an ensemble,
/// which are all equally far apart, it lost several times as much.
constexpr double kSmallStep = 0.5;
/// For the morph: if more of the source's area has been lost since the surface left the source, the next mapping starts
/// from the source again, which may recover some of it.
constexpr double kMaxUnmatchedOnPath = 0.005;

/// RMSD over the atoms that both have; NaN if there are none.
double rms_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    const Vec3d d = a[i] - b[i];
    const double square = dot(d, d);
    if (!std::isfinite(square)) continue;
    sum += square;
    ++n;
  }
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : std::numeric_limits<double>::quiet_NaN();
}

/// The same residues on the last target, with their motions to this one. Skips domains with too few paired atoms.
std::vector<RigidDomain> domains_on(const Molecule& last, const Molecule& source, const Molecule& target,
                                    const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                                    const std::vector<RigidDomain>& domains) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> domain_of(source.residues.size(), kNone);
  for (std::size_t k = 0; k < domains.size(); ++k) {
    for (const std::size_t r : domains[k].residues) domain_of[r] = k;
  }
  const std::vector<std::int32_t> source_residue = paired_residues(last, source, pair_atoms(last, source));
  std::vector<RigidDomain> on_last(domains.size());
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> own(domains.size());
  const auto domain_on_last = [&](std::size_t residue) {
    const std::int32_t s = source_residue[residue];
    return s < 0 ? kNone : domain_of[static_cast<std::size_t>(s)];
  };
  for (std::size_t r = 0; r < last.residues.size(); ++r) {
    if (const std::size_t k = domain_on_last(r); k != kNone) on_last[k].residues.push_back(r);
  }
  for (const auto& pair : pairs) {
    const std::size_t k = domain_on_last(static_cast<std::size_t>(last.atoms[pair.first].residue));
    if (k != kNone) own[k].push_back(pair);
  }
  std::vector<RigidDomain> moving;
  for (std::size_t k = 0; k < domains.size(); ++k) {
    try {
      on_last[k].motion = superpose(last.positions, target.positions, own[k]).transform;
    } catch (const GeometryError&) {
      continue;
    }
    moving.push_back(std::move(on_last[k]));
  }
  return moving;
}

}  // namespace

std::vector<Vec3d> counterparts(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                                const RigidTransform& to_common) {
  std::vector<Vec3d> positions(source.size(), Vec3d{kNaN, kNaN, kNaN});
  for (const auto& pair : pairing.pairs) positions[pair.first] = to_common.apply(target.positions[pair.second]);
  return positions;
}

LastStep after_deform(Engine& engine, const MeshPtr& regularized, const MeshPtr& mapped, std::vector<Vec3d> target) {
  const std::size_t n = engine.n_vertices(regularized);
  if (engine.n_vertices(mapped) == n) return {mapped, std::move(target)};
  std::vector<Vec3f> positions = engine.download_positions(mapped);
  positions.resize(n);
  return {engine.with_positions(regularized, positions), std::move(target)};
}

LastStep after_morph(const MorphResult& morphed, const Molecule& molecule, const RigidTransform& to_common,
                     std::vector<Vec3d> target, const LastStep* before, double unmatched) {
  LastStep last{morphed.mapped, std::move(target), morphed,
                molecule,       unmatched,         before != nullptr ? before->unmatched_at_start : unmatched};
  for (Vec3d& p : last.molecule.positions) p = to_common.apply(p);
  last.molecule.charges.clear();
  return last;
}

SeriesState state_of(Engine& engine, const LastStep& last) {
  SeriesState state{engine.download_positions(last.mapped), last.target, std::nullopt};
  if (last.morphed) {
    Mesh source = engine.download_shape(last.morphed->source);
    state.morph = SeriesState::Morph{std::move(source.positions),
                                     std::move(source.triangles),
                                     engine.download(last.morphed->unmatched),
                                     engine.download(last.morphed->path_length),
                                     last.molecule,
                                     last.unmatched,
                                     last.unmatched_at_start};
  }
  return state;
}

LastStep last_step_of(Engine& engine, const SeriesState& state, const MeshPtr& regularized, Method method) {
  if (state.morph.has_value() != (method == Method::kMorph))
    throw InputError("the saved state is of the method " + to_string(state.morph ? Method::kMorph : Method::kDeform) +
                     ", this series is by " + to_string(method) + "; start the series anew");
  const std::size_t n = engine.n_vertices(regularized), n_saved = state.mapped.size();
  if (state.morph ? n_saved < n : n_saved != n)
    throw InputError("the saved state is of a surface with " + std::to_string(n_saved) + " vertices, this one has " +
                     std::to_string(n) + "; start the series anew");
  if (!state.morph) return {engine.with_positions(regularized, state.mapped), state.target};
  Mesh source;
  source.positions = state.morph->source;
  source.triangles = state.morph->triangles;
  MorphResult morphed;
  morphed.source = engine.upload_mesh(source);
  morphed.mapped = engine.with_positions(morphed.source, state.mapped);
  morphed.unmatched = engine.upload_scalars(state.morph->unmatched);
  morphed.path_length = engine.upload_scalars(state.morph->path_length);
  return {morphed.mapped,
          state.target,
          morphed,
          state.morph->target,
          state.morph->unmatched_share,
          state.morph->unmatched_share_at_start};
}

bool can_continue(const LastStep& last, const Molecule& source, const CommonFrame& frame,
                  const std::vector<Vec3d>& target) {
  if (last.morphed && last.unmatched - last.unmatched_at_start > kMaxUnmatchedOnPath) return false;
  std::vector<Vec3d> moved;
  for (std::size_t i = 0; i < source.size(); ++i)
    moved.push_back(frame.domains.of(source.atoms[i].residue).apply(frame.from_source.apply(source.positions[i]), 1));
  const double nearer = last.morphed ? kSmallStep : 1.0;
  return rms_distance(last.target, target) < nearer * rms_distance(moved, target);
}

std::vector<MovingAtom> paths_from(const LastStep& last, const Molecule& source, const Molecule& target,
                                   const RigidTransform& from_target, const std::vector<RigidDomain>& domains,
                                   const CompareOptions& options, const Progress& progress) {
  const AtomPairing pairing = pair_atoms(last.molecule, target);
  DomainMotions motions;
  if (!domains.empty()) {
    const auto pairs =
        options.align == AlignAtoms::kNone ? pairing.pairs : select_pairs(pairing, last.molecule, options.align);
    motions = domain_motions(domains_on(last.molecule, source, target, pairs, domains), last.molecule, {}, from_target);
  }
  return atom_paths(last.molecule, target, pairing, {}, from_target, motions, options.surface.radius_scale, progress);
}

}  // namespace espdiff
