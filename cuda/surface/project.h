// project.h: projection onto the analytic isosurface by Newton's method.
#pragma once

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Moves each vertex along the density's gradient until the analytic density equals the isovalue to 1e-4. A vertex that
/// would move farther than `max_shift_A`, or finds no gradient, stays in place.
/// @param first  vertices before this one stay in place
std::shared_ptr<SurfaceMesh> project(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue, float max_shift_A,
                                     std::size_t first = 0);

/// The general form, in which each vertex takes all its steps at once; gives the same bits.
std::shared_ptr<SurfaceMesh> project_vertex_by_vertex(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue,
                                                      float max_shift_A, std::size_t first = 0);

}  // namespace espdiff::ESPDIFF_BACKEND
