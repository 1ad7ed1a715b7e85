// unwrap.h: molecules that the border of a periodic cell has cut, put together again.
#pragma once

#include <array>
#include <vector>

#include "base/vector.h"

namespace espdiff {

/// The shortest of v's images, v + i a + j b + k c with whole i, j, k. Exact in cells that are not much skewed: rounded
/// parts of the edges, and the images around these.
Vec3d shortest_image(Vec3d v, const std::array<Vec3d, 3>& edges);

/// Moves atoms by whole edges so that they lie as in the molecule. Each atom goes to the image nearest to the one
/// before it; where that is farther than 12 A away, as between chains, a new piece begins. Pieces then go where they
/// lie in the reference, seen from the largest piece; without a reference each to the image nearest to those placed
/// before it. Atoms that were never cut stay together, and move by a common shift at most.
/// @param atoms     positions in the order of the chain, neighbours near each other
/// @param edges     of the cell
/// @param reference the same atoms in a frame that is whole; empty where there is none
/// @throws InputError (edges that do not span space; another number of atoms in the reference)
std::vector<Vec3d> unwrapped(const std::vector<Vec3d>& atoms, const std::array<Vec3d, 3>& edges,
                             const std::vector<Vec3d>& reference);

}  // namespace espdiff
