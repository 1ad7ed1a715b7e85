// last_step.h: what a series keeps of its last step, and how the next one goes on from it.
#pragma once

#include <optional>
#include <vector>

#include "compare/common_frame.h"
#include "compare/options.h"
#include "compare/series.h"
#include "engine/handles.h"
#include "engine/morph_stage.h"

namespace espdiff {

struct CompareOptions;

/// A step's end, all in the common frame.
struct LastStep {
  MeshPtr mapped;             ///< by deform on the source's own vertices, without those that a subdivision added
  std::vector<Vec3d> target;  ///< see SeriesState
  std::optional<MorphResult> morphed{};  ///< by the morph: what its surface goes on from
  Molecule molecule{};                   ///< by the morph: the target
  double unmatched = 0;                  ///< by the morph: share of the source's area without counterpart
  double unmatched_at_start = 0;         ///< the same where the surface came from the source last
};

/// Where each source atom's counterpart lies, in the common frame; NaN where there is none.
std::vector<Vec3d> counterparts(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                                const RigidTransform& to_common);

LastStep after_deform(Engine& engine, const MeshPtr& regularized, const MeshPtr& mapped, std::vector<Vec3d> target);
/// @param before what the step went on from, null for the source; @param lost share of the source's area
LastStep after_morph(const MorphResult& morphed, const Molecule& molecule, const RigidTransform& to_common,
                     std::vector<Vec3d> target, const LastStep* before, double unmatched);

SeriesState state_of(Engine& engine, const LastStep& last);
/// @throws InputError when the state is of another surface than `regularized`, or of the other method
LastStep last_step_of(Engine& engine, const SeriesState& state, const MeshPtr& regularized, Method method);

/// Whether a mapping goes on from the last step's; see Series::step(). RMSD over the paired atoms, the source's domains
/// moved.
bool goes_on(const LastStep& last, const Molecule& source, const CommonFrame& frame, const std::vector<Vec3d>& target);

/// The ways of all atoms from the last target to this one; see atom_paths(). The source's rigid domains move from where
/// they are on the one to where they are on the other.
/// @param domains of source and target
std::vector<MovingAtom> paths_from(const LastStep& last, const Molecule& source, const Molecule& target,
                                   const RigidTransform& from_target, const std::vector<RigidDomain>& domains,
                                   const CompareOptions& options);

}  // namespace espdiff
