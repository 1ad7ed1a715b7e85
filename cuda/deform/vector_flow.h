// vector_flow.h: gradient vector flow: spreads a surface's inward normals over the whole lattice.
#pragma once

#include "base/progress.h"
#include "cuda/surface/density/grid.h"
#include "engine/deform_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The direction u that deform() follows, after Xu and Prince, IEEE Trans. Image Process. 7, 359 (1998). It minimizes
///
///     integral of  mu |grad u|^2 + |g|^2 |u - g|^2,   hence   mu lap u = |g|^2 (u - g),
///
/// with zero flux through the lattice's border. g is the gradient of the density, scaled to mean length 1 on the
/// surface, within half the isovalue of the surface; it vanishes smoothly beyond. There u follows from the surrounding
/// normals, in crevices and far away alike. In the paper g points at the edge from both sides; here it points inward on
/// both sides, as deform() needs it, so that the two sides do not cancel.
///
/// With a source (two-way) the source's normals are imposed too, except where the target's are: the surface leaves the
/// source and reaches the target along the normals of each.
///
/// Method: central differences, Jacobi iteration with Chebyshev acceleration (Golub and Varga, Numer. Math. 3, 147
/// (1961)). Each sweep solves every point's equation with the neighbours' previous values, which damps every mode at
/// any mu and spacing, so there is no time step to bound. Each point writes its own element of one of two buffers, so
/// the result does not depend on threads. The number of sweeps grows with the number of lattice points along an edge.
///
/// The field's scalar is density - isovalue.
/// @param source null for one-way flow; may have a different lattice
/// @throws InputError (options), Cancelled
std::shared_ptr<SurfaceField> vector_flow(const DensityGrid& target, const DensityGrid* source, float isovalue,
                                          const VectorFlowOptions& options, const Progress& progress,
                                          VectorFlowReport* report);

}  // namespace espdiff::ESPDIFF_BACKEND
