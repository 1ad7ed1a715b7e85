// vector_flow.h: gradient vector flow: the inward normals of a surface, spread over the whole lattice.
#pragma once

#include "base/progress.h"
#include "cuda/surface/grid.h"
#include "engine/deform_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The direction u in which deform() draws, after Xu and Prince, IEEE Trans. Image Process. 7, 359 (1998): it minimizes
///
///     integral of  mu |grad u|^2 + |g|^2 |u - g|^2,   hence   mu lap u = |g|^2 (u - g),
///
/// with nothing flowing through the lattice's border. g is the gradient of the density, 1 long on the average of the
/// surface, within half the isovalue of the surface, and vanishes smoothly beyond: there u follows from the normals
/// around, into crevices and from afar alike. In the paper g points at the edge from both sides; here it points inward
/// on both, as deform() wants it, so that the two sides do not cancel.
///
/// With a source (two-way) the source's normals are held as well, but where the target's are: the surface leaves the
/// source and arrives at the target along the normals of each.
///
/// Method: central differences; Jacobi's iteration with Chebyshev's acceleration (Golub and Varga, Numer. Math. 3, 147
/// (1961)). Each sweep solves every point's equation with its neighbours as they were, which damps every mode at any mu
/// and spacing: there is no time step to bound. Each point writes its own element of one of two buffers, so that the
/// result does not depend on threads. The number of sweeps grows with the lattice's size in points along an edge.
///
/// The field's scalar is density - isovalue.
/// @param source null for the one-way flow; may have another lattice
/// @throws InputError (options), Cancelled
std::shared_ptr<SurfaceField> vector_flow(const DensityGrid& target, const DensityGrid* source, float isovalue,
                                          const VectorFlowOptions& options, const Progress& progress,
                                          VectorFlowReport* report);

}  // namespace espdiff::ESPDIFF_BACKEND
