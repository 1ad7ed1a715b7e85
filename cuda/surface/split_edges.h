// split_edges.h: halves chosen edges of a closed mesh; the triangles at them are divided so that it stays closed.
#pragma once

#include "cuda/surface/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// What a division gives. Old vertices keep their numbers; vertex n_old + k lies in the middle of the edge between
/// ends[k].
struct EdgeSplit {
  std::shared_ptr<const Topology> topology;
  struct Ends {
    std::uint32_t a, b;
  };
  Buffer<Ends> ends;             ///< [new vertex]
  Buffer<std::uint32_t> parent;  ///< [triangle] the triangle that it is a part of
};

/// Halves the edges marked: a triangle with one, two or three of them becomes two, three or four; of the two ways to
/// divide the quadrangle that two leave over, the one with the shorter diagonal is taken.
/// @param marked    [3 * triangle] by place in the topology's rows: nonzero at place p of row v halves the edge from v
///                  to neighbour[p]; only places with v < neighbour[p] are read
/// @param positions [vertex] that measure diagonals
EdgeSplit split_edges(const Topology& topology, const Buffer<std::uint32_t>& marked, const Buffer<Vec4f>& positions);

}  // namespace espdiff::ESPDIFF_BACKEND
