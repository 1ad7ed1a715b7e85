// superpose.h: least-squares superposition of paired points.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "base/molecule/screw.h"
#include "base/types.h"

namespace espdiff {

struct Superposition {
  RigidTransform transform;  ///< moving -> fixed
  double rmsd_A = 0;         ///< over the pairs, after the transform
};

/// Kabsch's method: both point sets centred at the origin, R = W diag(1,1,d) V^T from the singular value decomposition
/// of their covariance, d = +-1 so that R is a rotation (Kabsch, Acta Cryst. A32, 922 (1976); thesis eq. 3.3-3.7 with
/// errata).
/// @param pairs (index into moving, index into fixed)
/// @throws GeometryError if there are fewer than 3 pairs, the points are collinear (the rotation is undetermined), or a
/// position is not finite
Superposition superpose(const std::vector<Vec3d>& moving, const std::vector<Vec3d>& fixed,
                        const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

/// RMSD over the pairs as given, Angstrom.
double rmsd(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b,
            const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

RigidTransform inverse(const RigidTransform& transform);
/// x -> outer(inner(x)).
RigidTransform compose(const RigidTransform& outer, const RigidTransform& inner);

/// The motion as a rotation about an axis and a translation along it (Chasles' theorem). Rotations below 1e-6 are
/// dropped, leaving only the translation.
Screw screw_of(const RigidTransform& transform);

/// A molecule's principal frame: origin at the centroid, axes along the principal axes of its atoms (largest extent
/// first), signs by third moments, right-handed. Depends on the shape only, not on position, orientation or atom order.
/// @returns original coordinates -> principal frame
RigidTransform principal_frame(const std::vector<Vec3d>& positions);

}  // namespace espdiff
