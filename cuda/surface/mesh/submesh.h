// submesh.h: part of a mesh as its own mesh.
#pragma once

#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The triangles with nonzero `kept` and the vertices that they use, both in their old order. The mesh is open where
/// neighbouring triangles were removed; one-rings at the border then lack their last vertex.
/// @param kept [triangle]
/// @throws GeometryError if nothing remains
std::shared_ptr<SurfaceMesh> keep_triangles(const SurfaceMesh& mesh, const Buffer<std::uint8_t>& kept);

}  // namespace espdiff::ESPDIFF_BACKEND
