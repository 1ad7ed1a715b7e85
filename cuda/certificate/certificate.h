// certificate.h: how well a mapped mesh fits its target: corrupt and flipped triangles, distances in both directions,
// irregularity.
#pragma once

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"
#include "cuda/surface/mesh/triangle_tree.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// A triangle is corrupt if the density at its centroid differs from the isovalue by more than this (thesis section
/// 3.5.6).
constexpr float kCorruptDensity = 0.1F;

FitReport fit_to_density(const SurfaceMesh& mapped, const AtomCells& target, float isovalue);

/// The fit of a mesh without some of its triangles, from that of the whole mesh.
/// @param removed [triangle of the whole] nonzero if it is not in the part
FitReport fit_without(const SurfaceMesh& part, const FitReport& whole, const Buffer<float>& removed);

/// Exact distances from the corners (a quarter of each triangle's area) and centroids (the rest) of `from` to the
/// triangles of `to`.
DistanceSummary distance_summary(const SurfaceMesh& from, const SurfaceMesh& to, float limit_A);

/// The distances of a mesh without some of its triangles, from those of the whole mesh.
/// @param removed [triangle of the whole] nonzero if it is not in the part
DistanceSummary distances_without(const SurfaceMesh& part, const SurfaceMesh& mesh, const DistanceSummary& whole,
                                  const Buffer<float>& removed, float limit_A);

}  // namespace espdiff::ESPDIFF_BACKEND
