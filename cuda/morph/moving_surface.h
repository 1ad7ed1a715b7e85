// moving_surface.h: a surface on its way from source to target, and what a step of the morph does to it.
#pragma once

#include "cuda/morph/moving_atoms.h"
#include "cuda/surface/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The surface at one time. Its topology stays that of a closed mesh: what is cut out is marked, not removed.
struct MovingSurface {
  std::shared_ptr<const Topology> topology;
  Buffer<Vec4f> source;    ///< [vertex] where it comes from
  Buffer<Vec4f> x;         ///< [vertex] where it is; w: the length of its way so far
  Buffer<Vec4f> flow;      ///< [vertex] the atoms' velocity; w: what keeps it on the level set, A uphill per time
  Buffer<Vec4f> previous;  ///< [vertex] flow of the step before
  Buffer<Vec4f> gradient;  ///< [vertex] of the density, which lies in w
  Buffer<std::uint8_t> unmatched;  ///< [vertex] nonzero: has left the level set for good; goes on with the atoms alone
  Buffer<std::uint8_t> cut;        ///< [triangle] nonzero: no longer part of the surface
  Buffer<std::uint32_t> order;     ///< the vertices in a spatial order

  std::size_t n_vertices() const { return x.size(); }
  std::size_t n_triangles() const { return cut.size(); }
};

/// What kernels see of it.
struct MovingSurfaceView {
  TopologyView topology;
  Vec4f* source;
  Vec4f* x;
  Vec4f* flow;
  Vec4f* previous;
  Vec4f* gradient;
  std::uint8_t* unmatched;
  std::uint8_t* cut;
};

inline MovingSurfaceView view_of(MovingSurface& s) {
  const TopologyView topology{s.n_vertices(),
                              s.n_triangles(),
                              raw(s.topology->triangles),
                              raw(s.topology->first),
                              raw(s.topology->neighbour),
                              raw(s.topology->incident)};
  return {topology,        raw(s.source),   raw(s.x),         raw(s.flow),
          raw(s.previous), raw(s.gradient), raw(s.unmatched), raw(s.cut)};
}

/// Below this slope of the density, 1/Angstrom, there is no telling which way the level set lies.
constexpr float kLeastSlope = 0.02F;

/// A surface at rest on its mesh.
MovingSurface set_out(const SurfaceMesh& mesh);

/// Moves every vertex with the flow (follow_level_set.cu).
void advance(MovingSurface& surface, float dt);

/// Newton's method back onto the level set, and the flow there; vertices that cannot be brought back are lost
/// (follow_level_set.cu).
void return_to_level_set(MovingSurface& surface, const MovingAtoms& atoms, float isovalue);

/// Cuts out the triangles that have lost a corner or turned over, and gives up vertices whose side has turned or that
/// are in no triangle any more (remove_torn_triangles.cu).
void remove_torn_triangles(MovingSurface& surface);

/// Moves vertices whose triangles are much worse in shape than on the source toward the middle of their ring, along the
/// surface, by at most a third of the least altitude around, so that no triangle turns over (smooth_tangentially.cu).
void smooth_tangentially(MovingSurface& surface);

/// Halves edges longer than `max_edge_A`; gives up a vertex where such an edge has grown more than `max_stretch` times
/// (split_long_edges.cu).
/// @returns the number of vertices added
std::size_t split_long_edges(MovingSurface& surface, float max_edge_A, float max_stretch);

}  // namespace espdiff::ESPDIFF_BACKEND
