// intersections.h: counts the pairs of triangles of a closed mesh that intersect.
#pragma once

#include "cuda/surface/mesh.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::self_intersections(). Candidates come from the triangle tree: each leaf is compared with itself and with
/// the later leaves whose boxes overlap its own. Each pair of triangles with overlapping boxes is decided exactly
/// (triangle_pairs.h). A protein's surface has about eight such pairs per triangle; most share a vertex and are ruled
/// out by two signs. Integer counts only, so the result is the same for any number of threads.
IntersectionReport self_intersections(const SurfaceMesh& mesh);

}  // namespace espdiff::ESPDIFF_BACKEND
