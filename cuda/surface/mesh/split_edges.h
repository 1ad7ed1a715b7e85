// split_edges.h: splits chosen edges of a closed mesh at their midpoints, and their triangles so that it stays closed.
#pragma once

#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Result of a split. Old vertices keep their numbers; vertex n_old + k is the midpoint of the edge between ends[k].
struct EdgeSplit {
  std::shared_ptr<const Topology> topology;
  struct Ends {
    std::uint32_t a, b;
  };
  Buffer<Ends> ends;             ///< [new vertex]
  Buffer<std::uint32_t> parent;  ///< [triangle] the triangle it is part of
};

/// Splits the marked edges. A triangle with one, two or three marked edges becomes two, three or four. With two, the
/// remaining quadrangle is divided along its shorter diagonal.
/// @param marked    [3 * triangle] by place in the topology's rows: nonzero at place p of row v splits the edge from v
/// to neighbour[p]; only places with v < neighbour[p] are read
/// @param positions [vertex] used to measure diagonals
EdgeSplit split_edges(const Topology& topology, const Buffer<std::uint32_t>& marked, const Buffer<Vec4f>& positions);

}  // namespace espdiff::ESPDIFF_BACKEND
