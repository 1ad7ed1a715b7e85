// submesh.h: a part of a mesh as a mesh of its own.
#pragma once

#include "cuda/surface/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The triangles whose entry in `kept` is nonzero and the vertices that they use, both in their old order. Where
/// neighbouring triangles are left out the mesh is open; rows of one-rings then lack the border's last vertex.
/// @param kept [triangle]
/// @throws GeometryError when nothing is left
std::shared_ptr<SurfaceMesh> keep_triangles(const SurfaceMesh& mesh, const Buffer<std::uint8_t>& kept);

}  // namespace espdiff::ESPDIFF_BACKEND
