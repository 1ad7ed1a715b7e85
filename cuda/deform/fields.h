// fields.h: the fields that deform() follows: density, and distance where it is far from the surface.
#pragma once

#include "base/progress.h"
#include "cuda/surface/grid.h"
#include "cuda/surface/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// value = density - isovalue, gradient by central differences.
std::shared_ptr<SurfaceField> density_field(const DensityGrid& density, float isovalue);

/// Mean slope of the density near the surface, 1/Angstrom: turns the density's excess into a length. 1 where the
/// lattice has no point near the surface.
float surface_slope(const SurfaceField& density_field, float isovalue);

/// Signed distance to the surface (positive inside) where its magnitude exceeds the threshold, with its gradient; the
/// density field elsewhere, divided by its mean slope at the surface so that both are lengths. The distance is that to
/// the triangles around the nearest vertex, which is found by sweeps along the lattice's rows; it is compared with
/// exact distances in the tests. Both point inward and vanish on the surface, so that a vertex passes from one to the
/// other smoothly.
std::shared_ptr<SurfaceField> distance_field(const DensityGrid& density, float isovalue, const SurfaceMesh& surface,
                                             float threshold_A, const Progress& progress);

}  // namespace espdiff::ESPDIFF_BACKEND
