// intersections.h: the pairs of triangles of a closed mesh that intersect.
#pragma once

#include "cuda/surface/mesh.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::self_intersections(). Candidates come from the triangle tree: each leaf is compared with itself and with
/// the leaves behind it whose boxes overlap its own, and each pair of triangles whose boxes overlap is decided exactly
/// (triangle_pairs.h). On a protein's surface these are eight pairs a triangle, most of which share a vertex and are
/// ruled out by two signs. Counts only, in integers: the same result for any number of threads.
IntersectionReport self_intersections(const SurfaceMesh& mesh);

}  // namespace espdiff::ESPDIFF_BACKEND
