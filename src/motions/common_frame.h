// common_frame.h: the common frame of a comparison's two molecules.
#pragma once

#include <string>

#include "motions/alignment.h"
#include "motions/domain_motions.h"

namespace espdiff {

struct CompareOptions;

/// The common frame of both molecules: the source's principal frame, into which the target is superposed. Grids follow
/// the axes of the shape itself, so a rigid motion of either input changes only rounding.
struct CommonFrame {
  RigidTransform from_source, from_target;  // own frame -> common frame
  DomainMotions domains{};
  DomainMotions followed{};  ///< what atoms follow to the target: the domains, or each residue's own motion
  /// The value of the setting `domains` that `followed` stands for: with `as-needed`, `none` or `local`.
  std::string follows = "none";
};

/// Two molecules, paired and superposed.
struct AlignedStates {
  CommonFrame frame;
  Alignment alignment;
};

/// Pairs atoms, superposes the target, and finds the rigid domains, as the options say. With `as-needed` everything
/// follows the superposition of the whole.
/// @throws InputError (no pairs where they are needed, domains), GeometryError (too few pairs)
AlignedStates align(const Molecule& source, const Molecule& target, const CompareOptions& options);

}  // namespace espdiff
