// common_frame.h: the common frame of a comparison's two molecules.
#pragma once

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
};

/// Pairs atoms, superposes the target, and finds the rigid domains, as the options say. With `as-needed` everything
/// follows the superposition of the whole.
/// @param result receives the pairing, the superposition and its RMSD, and the domains
/// @throws InputError (no pairs where they are needed, domains), GeometryError (too few pairs)
CommonFrame align(const Molecule& source, const Molecule& target, const CompareOptions& options, Alignment& result);

}  // namespace espdiff
