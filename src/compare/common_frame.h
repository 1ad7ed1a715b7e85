// common_frame.h: where both molecules of a comparison meet.
#pragma once

#include "compare/domain_motions.h"

namespace espdiff {

/// Where both molecules meet: the source's principal frame, into which the target is superposed. Grids are thus laid
/// along axes of the shape itself, and a rigid motion of either input changes nothing but rounding.
struct CommonFrame {
  RigidTransform from_source, from_target;  // own frame -> common frame
  DomainMotions domains{};
};

/// Pairs atoms, superposes the target, and finds the rigid domains that are aligned by themselves, as the options say.
/// @param result gets the pairing, the superposition and its RMSD, and the domains
/// @throws InputError (nothing pairs where that is needed, domains), GeometryError (too few pairs)
CommonFrame align(const Molecule& source, const Molecule& target, const CompareOptions& options, CompareResult& result);

}  // namespace espdiff
