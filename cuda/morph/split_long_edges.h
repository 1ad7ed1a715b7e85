// split_long_edges.h: splits the edges that have grown too long.
#pragma once

#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Edges to be split.
struct LongEdges {
  Buffer<std::uint32_t> marks;  ///< as split_edges() takes them
  Buffer<std::size_t> n;        ///< [0] how many
};

/// Finds the edges longer than `max_edge_A` of which an end does not wait; a vertex becomes unmatched where such an
/// edge has grown more than `max_stretch` times.
LongEdges find_long_edges(MovingSurface& surface, float max_edge_A, float max_stretch);

/// Splits them; waits for their number.
/// @returns the number of vertices added
std::size_t split_long_edges(MovingSurface& surface, const LongEdges& edges);

}  // namespace espdiff::ESPDIFF_BACKEND
