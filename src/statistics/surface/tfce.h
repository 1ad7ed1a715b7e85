// tfce.h: threshold-free cluster enhancement on a mesh.
#pragma once

#include <vector>

namespace espdiff {

struct MeshGraph;

/// Smith & Nichols 2009, NeuroImage 44:83: E and H as recommended there.
struct TfceOptions {
  double extent_power = 0.5, height_power = 2;
};

/// Threshold-free cluster enhancement: a vertex's score is the integral over all thresholds h from 0 to its |value| of
/// extent(h)^E h^H dh, where extent(h) is the area of its connected piece above h; with the sign of its value. Pieces
/// of positive and of negative values are separate.
///
/// The integral is exact, without steps: pieces are merged while the threshold falls (union-find), and between two
/// merges their extent is constant. O(n log n).
/// @param values [vertex]; NaN is left out and separates pieces; its score is 0
std::vector<double> enhance_clusters(const std::vector<double>& values, const MeshGraph& graph,
                                     const TfceOptions& options = {});

}  // namespace espdiff
