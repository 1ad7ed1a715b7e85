// unwrap.h: makes molecules whole that cross the border of a periodic cell.
#pragma once

#include <array>
#include <vector>

#include "base/vector.h"

namespace espdiff {

/// The shortest periodic image of v, v + i a + j b + k c with whole i, j, k. Exact in cells that are not strongly
/// skewed: rounds the fractional coordinates and tries the neighbouring images.
Vec3d shortest_image(Vec3d v, const std::array<Vec3d, 3>& edges);

/// Moves atoms by lattice vectors so that the molecule is whole. Each atom takes the image nearest to the previous
/// atom; if that is farther than 12 A, as between chains, a new part begins. Parts are then placed as in the reference,
/// relative to the largest part; without a reference each takes the image nearest to the parts before it. Atoms that
/// were never wrapped stay together and move at most by a common shift.
/// @param atoms     positions in chain order
/// @param edges     of the cell
/// @param reference the same atoms in a whole frame; empty for none
/// @throws InputError (edges that do not span space; a reference with a different number of atoms)
std::vector<Vec3d> unwrapped(const std::vector<Vec3d>& atoms, const std::array<Vec3d, 3>& edges,
                             const std::vector<Vec3d>& reference);

}  // namespace espdiff
