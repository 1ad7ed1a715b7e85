// atom_field.h: values of atoms at the vertices of a surface, in two forms with the same bits.
#pragma once

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/mesh/mesh.h"
#include "engine/field_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::atom_field(). The CPU goes through blocks of neighbouring vertices.
Buffer<float> atom_field(const SurfaceMesh& mesh, const AtomValues& atoms);

/// The general form, point by point; gives the same bits.
Buffer<float> atom_field_point_by_point(const SurfaceMesh& mesh, const AtomValues& atoms);

}  // namespace espdiff::ESPDIFF_BACKEND
