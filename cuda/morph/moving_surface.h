// moving_surface.h: the surface between source and target, and the operations of one step of the morph.
#pragma once

#include "cuda/morph/moving_atoms.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The surface at one time. Its topology stays closed: removed triangles are only marked.
struct MovingSurface {
  std::shared_ptr<const Topology> topology;
  Buffer<Vec4f> source;    ///< [vertex] position on the source
  Buffer<Vec4f> x;         ///< [vertex] current position; w: path length so far
  Buffer<Vec4f> flow;      ///< [vertex] the atoms' velocity; w: the correction that keeps it on the level set, A uphill
                           ///< per time
  Buffer<Vec4f> previous;  ///< [vertex] flow of the previous step
  Buffer<Vec4f> gradient;  ///< [vertex] gradient of the density; w: the density
  Buffer<std::uint8_t> unmatched;  ///< [vertex] nonzero: has left the level set for good; moves with the atoms only
  Buffer<std::uint8_t> removed;    ///< [triangle] nonzero: no longer part of the surface
  Buffer<std::uint32_t> order;     ///< the vertices in a spatial order

  std::size_t n_vertices() const { return x.size(); }
  std::size_t n_triangles() const { return removed.size(); }
};

/// Kernel view of the surface.
struct MovingSurfaceView {
  TopologyView topology;
  Vec4f* source;
  Vec4f* x;
  Vec4f* flow;
  Vec4f* previous;
  Vec4f* gradient;
  std::uint8_t* unmatched;
  std::uint8_t* removed;
};

inline MovingSurfaceView view_of(MovingSurface& s) {
  const TopologyView topology{s.n_vertices(),
                              s.n_triangles(),
                              raw(s.topology->triangles),
                              raw(s.topology->first),
                              raw(s.topology->neighbour),
                              raw(s.topology->incident)};
  return {topology,        raw(s.source),   raw(s.x),         raw(s.flow),
          raw(s.previous), raw(s.gradient), raw(s.unmatched), raw(s.removed)};
}

/// Below this slope of the density, 1/Angstrom, the direction of the level set is undetermined.
constexpr float kLeastSlope = 0.02F;

/// The surface at the start: no motion, no removed triangle.
MovingSurface start_surface(const SurfaceMesh& mesh);

/// Moves every vertex with the flow (follow_level_set.cu).
void advance(MovingSurface& surface, float dt);

/// Returns vertices to the level set by Newton's method and evaluates the flow there; vertices that cannot return
/// become unmatched (follow_level_set.cu).
/// @param settled  [vertex] positions after an earlier call with the same atoms: vertices that are still there keep
///                 place and flow; empty, or for vertices that were added since, none do
void return_to_level_set(MovingSurface& surface, const MovingAtoms& atoms, float isovalue,
                         const Buffer<Vec4f>& settled = {});

/// The general form, in which each vertex takes all its steps at once; gives the same bits.
void return_vertex_by_vertex(MovingSurface& surface, const MovingAtoms& atoms, float isovalue,
                             const Buffer<Vec4f>& settled = {});

/// Removes triangles that have an unmatched vertex or are flipped. Vertices become unmatched if their normal is flipped
/// or no triangle remains at them (remove_torn_triangles.cu).
void remove_torn_triangles(MovingSurface& surface);

/// Smooths vertices whose triangles have a much worse shape than on the source: moves them toward the mean of their
/// ring, along the surface, by at most a third of the smallest altitude, so that no triangle flips
/// (smooth_tangentially.cu).
void smooth_tangentially(MovingSurface& surface);

/// Edges to be split.
struct LongEdges {
  Buffer<std::uint32_t> marks;  ///< as split_edges() takes them
  Buffer<std::size_t> n;        ///< [0] how many
};

/// Finds the edges longer than `max_edge_A`; a vertex becomes unmatched where such an edge has grown more than
/// `max_stretch` times (split_long_edges.cu).
LongEdges find_long_edges(MovingSurface& surface, float max_edge_A, float max_stretch);

/// Splits them; waits for their number.
/// @returns the number of vertices added
std::size_t split_long_edges(MovingSurface& surface, const LongEdges& edges);

}  // namespace espdiff::ESPDIFF_BACKEND
