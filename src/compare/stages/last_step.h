// last_step.h: the state that a series keeps of its last step, and how the next step continues from it.
#pragma once

#include <optional>
#include <vector>

#include "base/handles.h"
#include "base/progress.h"
#include "compare/stages/series_state.h"
#include "engine/morph_stage.h"
#include "motions/common_frame.h"
#include "options/options.h"

namespace espdiff {

struct CompareOptions;

/// The end of a step; all in the common frame.
struct LastStep {
  MeshPtr mapped;                        ///< by deform: without the vertices that a subdivision added
  std::vector<Vec3d> target;             ///< see SeriesState
  std::optional<MorphResult> morphed{};  ///< by the morph: its state to continue from
  Molecule molecule{};                   ///< by the morph: the target
  double unmatched = 0;                  ///< by the morph: unmatched fraction of the source's area
  double unmatched_at_start = 0;         ///< the same for the last step that started from the source
};

/// [source atom] position of its paired target atom, in the common frame; NaN if unpaired.
std::vector<Vec3d> counterparts(const Molecule& source, const Molecule& target, const AtomPairing& pairing,
                                const RigidTransform& to_common);

LastStep after_deform(Engine& engine, const MeshPtr& regularized, const MeshPtr& mapped, std::vector<Vec3d> target);
/// @param before the step that was continued, null for the source; @param unmatched fraction of the source's area
LastStep after_morph(const MorphResult& morphed, const Molecule& molecule, const RigidTransform& to_common,
                     std::vector<Vec3d> target, const LastStep* before, double unmatched);

SeriesState state_of(Engine& engine, const LastStep& last);
/// @throws InputError if the state is of a surface other than `regularized`, or of the other method
LastStep last_step_of(Engine& engine, const SeriesState& state, const MeshPtr& regularized, Method method);

/// Whether a mapping continues from the last step's; see Series::step(). Compares RMSDs over the paired atoms, with the
/// source's domains moved.
bool can_continue(const LastStep& last, const Molecule& source, const CommonFrame& frame,
                  const std::vector<Vec3d>& target);

/// The paths of all atoms from the last target to this one; see atom_paths(). The source's rigid domains move from
/// their position on the last target to that on this one.
/// @param domains of source and target
std::vector<MovingAtom> paths_from(const LastStep& last, const Molecule& source, const Molecule& target,
                                   const RigidTransform& from_target, const std::vector<RigidDomain>& domains,
                                   const CompareOptions& options, const Progress& progress);

}  // namespace espdiff
