// distances_to_triangles.h: distances of many points to a surface, in two forms with the same bits.
#pragma once

#include "cuda/surface/mesh/triangle_tree.h"

namespace espdiff::ESPDIFF_BACKEND {

/// [point] distance to the nearest triangle of the tree. The CPU searches for blocks of neighbouring points together.
Buffer<float> distances_to_triangles(const TriangleTree& tree, const Buffer<Vec4f>& points);

/// The general form, point by point; gives the same bits.
Buffer<float> distances_point_by_point(const TriangleTree& tree, const Buffer<Vec4f>& points);

}  // namespace espdiff::ESPDIFF_BACKEND
