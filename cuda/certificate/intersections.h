// intersections.h: counts the pairs of triangles of a closed mesh that intersect.
#pragma once

#include "cuda/surface/mesh/mesh.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

/// See Engine::self_intersections(). Candidates come from the triangle tree: each leaf is compared with itself and with
/// the later leaves whose boxes overlap its own; the CPU takes groups of four leaves. A protein's surface has about
/// eight pairs of triangles with overlapping boxes per triangle. Most share a vertex, and are ruled out at once
/// (fans.h); the others are decided exactly (triangle_pairs.h). Integer counts only, so the result is the same for any
/// number of threads.
IntersectionReport self_intersections(const SurfaceMesh& mesh);

/// The general form, leaf by leaf; gives the same numbers.
IntersectionReport self_intersections_leaf_by_leaf(const SurfaceMesh& mesh);

}  // namespace espdiff::ESPDIFF_BACKEND
