// fields.h: the fields that deform() follows: density near the surface, distance far from it.
#pragma once

#include "base/progress.h"
#include "cuda/surface/density/grid.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// value = density - isovalue, gradient by central differences.
std::shared_ptr<SurfaceField> density_field(const DensityGrid& density, float isovalue);

/// Mean slope of the density near the surface, 1/Angstrom; converts a density difference into a length. 1 if the
/// lattice has no point near the surface.
float surface_slope(const SurfaceField& density_field, float isovalue);

/// Signed distance to the surface (positive inside) with its gradient where its magnitude exceeds the threshold;
/// elsewhere the density field divided by its mean slope at the surface, so that both are lengths. The distance is to
/// the triangles around the nearest vertex, which sweeps along the lattice's rows find; tests compare it with exact
/// distances. Both fields point inward and vanish on the surface, so a vertex passes smoothly from one to the other.
std::shared_ptr<SurfaceField> distance_field(const DensityGrid& density, float isovalue, const SurfaceMesh& surface,
                                             float threshold_A, const Progress& progress);

}  // namespace espdiff::ESPDIFF_BACKEND
