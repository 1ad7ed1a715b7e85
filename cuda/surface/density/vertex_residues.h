// vertex_residues.h: whose atoms a vertex belongs to, in two forms with the same bits.
#pragma once

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// [vertex] the label (AtomCells::residue) whose atoms have the largest density there, the smallest of equal ones; -1
/// where no atom reaches. The CPU goes through blocks of neighbouring vertices.
Buffer<std::int32_t> vertex_residues(const SurfaceMesh& mesh, const AtomCells& atoms);

/// The general form, point by point; gives the same bits.
Buffer<std::int32_t> vertex_residues_point_by_point(const SurfaceMesh& mesh, const AtomCells& atoms);

}  // namespace espdiff::ESPDIFF_BACKEND
