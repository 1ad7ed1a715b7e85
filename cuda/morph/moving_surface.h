// moving_surface.h: the surface between source and target, on which the steps of the morph work.
#pragma once

#include "cuda/morph/moving_atoms.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// When the flow of a vertex was evaluated, in steps of the morph.
struct VertexClock {
  std::uint32_t last;               ///< the step of the last time
  std::uint32_t previous_interval;  ///< from the time before to the last one; at least 1
  std::uint32_t interval;           ///< from the last time to the next one; at least 1
};

/// The surface at one time. Its topology stays closed: removed triangles are only marked.
struct MovingSurface {
  std::shared_ptr<const Topology> topology;
  Buffer<Vec4f> source;    ///< [vertex] position on the source
  Buffer<Vec4f> x;         ///< [vertex] current position; w: path length so far
  Buffer<Vec4f> flow;      ///< [vertex] the atoms' velocity; w: the correction that keeps it on the level set, A uphill
                           ///< per time
  Buffer<Vec4f> previous;  ///< [vertex] flow of the evaluation before
  Buffer<VertexClock> clock;       ///< [vertex]
  Buffer<Vec4f> gradient;          ///< [vertex] gradient of the density; w: the density
  Buffer<std::uint8_t> unmatched;  ///< [vertex] nonzero: has left the level set for good; moves with the atoms only
  Buffer<std::uint8_t> waits;      ///< [vertex] nonzero: its flow is not evaluated now
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
  VertexClock* clock;
  std::uint8_t* unmatched;
  std::uint8_t* waits;
  std::uint8_t* removed;
};

inline MovingSurfaceView view_of(MovingSurface& s) {
  const TopologyView topology{s.n_vertices(),
                              s.n_triangles(),
                              raw(s.topology->triangles),
                              raw(s.topology->first),
                              raw(s.topology->neighbour),
                              raw(s.topology->incident)};
  return {topology,        raw(s.source), raw(s.x),         raw(s.flow),  raw(s.previous),
          raw(s.gradient), raw(s.clock),  raw(s.unmatched), raw(s.waits), raw(s.removed)};
}

/// Whether nothing is to be done at a triangle now.
ESPDIFF_INLINE bool all_wait(const MovingSurfaceView& s, const Corners& c) {
  return s.waits[c.v[0]] != 0 && s.waits[c.v[1]] != 0 && s.waits[c.v[2]] != 0;
}

/// Below this slope of the density, 1/Angstrom, the direction of the level set is undetermined.
constexpr float kLeastSlope = 0.02F;

}  // namespace espdiff::ESPDIFF_BACKEND
