// cgal_mesh.h: our meshes as CGAL's.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <doctest/doctest.h>

#include "base/types.h"

namespace espdiff_test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// Face t is triangle t.
inline CgalMesh cgal_mesh(const espdiff::Mesh& mesh) {
  CgalMesh result;
  for (const espdiff::Vec3f& p : mesh.positions) {
    const auto exact = static_cast<espdiff::Vec3d>(p);
    result.add_vertex(Kernel::Point_3(exact.x, exact.y, exact.z));
  }
  for (const auto& t : mesh.triangles) {
    const auto face =
        result.add_face(CgalMesh::Vertex_index(t[0]), CgalMesh::Vertex_index(t[1]), CgalMesh::Vertex_index(t[2]));
    REQUIRE(face != CgalMesh::null_face());
    REQUIRE(face.idx() + 1 == result.number_of_faces());
  }
  return result;
}

}  // namespace espdiff_test
