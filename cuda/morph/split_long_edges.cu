// split_long_edges.cu: splits edges that have grown too long; the surface is torn where an edge is stretched beyond a
// limit.
#include "cuda/morph/split_long_edges.h"

#include "cuda/device/spatial_order.h"
#include "cuda/morph/moving_surface.h"
#include "cuda/surface/mesh/split_edges.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr std::uint32_t kHalve = 1, kTorn = 2;

ESPDIFF_INLINE Vec4f middle(const Vec4f& a, const Vec4f& b) { return 0.5F * (a + b); }

/// The added vertex is evaluated in the next step.
ESPDIFF_INLINE VertexClock middle(const VertexClock& a, const VertexClock& b) {
  return {a.last > b.last ? a.last : b.last,
          a.previous_interval > b.previous_interval ? a.previous_interval : b.previous_interval, 1};
}

/// Values of all vertices: each added one has the middle of its edge's ends.
template <typename T>
Buffer<T> with_middles(const Buffer<T>& values, const EdgeSplit& split) {
  const std::size_t n = values.size();
  Buffer<T> result = values;
  result.resize(n + split.ends.size());
  T* const out = raw(result);
  const EdgeSplit::Ends* const ends = raw(split.ends);
  for_each_index(split.ends.size(),
                 [=] ESPDIFF_HD(std::size_t k) { out[n + k] = middle(out[ends[k].a], out[ends[k].b]); });
  return result;
}

}  // namespace

LongEdges find_long_edges(MovingSurface& surface, float max_edge_A, float max_stretch) {
  const MovingSurfaceView s = view_of(surface);
  LongEdges edges;
  edges.marks.resize(3 * surface.removed.size());
  std::uint32_t* const mark = raw(edges.marks);
  for_each_index(surface.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    for (std::uint32_t p = s.topology.first[v]; p < s.topology.first[v + 1]; ++p) {
      mark[p] = 0;
      const std::uint32_t other = s.topology.neighbour[p];
      if (v > other || (s.waits[v] != 0 && s.waits[other] != 0)) continue;
      if (s.unmatched[v] != 0 || s.unmatched[other] != 0) continue;
      const Vec3f edge = s.x[v].xyz() - s.x[other].xyz();
      const float length = norm(edge);
      if (length <= max_edge_A) continue;
      // An edge is part of the surface unless both of its triangles are removed.
      bool live = false;
      for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n) {
        const std::uint32_t t = s.topology.incident[n];
        const Corners c = s.topology.triangles[t];
        live = live || (s.removed[t] == 0 && (c.v[0] == other || c.v[1] == other || c.v[2] == other));
      }
      if (!live) continue;
      const float from = norm(s.source[v].xyz() - s.source[other].xyz());
      mark[p] = length > max_stretch * from ? kTorn : kHalve;
    }
  });
  // Tear the surface where it is stretched beyond the limit.
  for_each_index(surface.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    for (std::uint32_t p = s.topology.first[v]; p < s.topology.first[v + 1]; ++p) {
      if (mark[p] != kTorn) continue;
      mark[p] = 0;
      s.unmatched[v] = 1;
    }
  });
  edges.n =
      sum_on_device<std::size_t>(edges.marks.size(), [=] ESPDIFF_HD(std::size_t p) { return std::size_t{mark[p]}; });
  return edges;
}

std::size_t split_long_edges(MovingSurface& surface, const LongEdges& edges) {
  if (edges.n[0] == 0) return 0;
  EdgeSplit split = split_edges(*surface.topology, edges.marks, surface.x);
  Buffer<std::uint8_t> removed(split.parent.size());
  const std::uint8_t* const was_removed = raw(surface.removed);
  std::uint8_t* const is_removed = raw(removed);
  const std::uint32_t* const parent = raw(split.parent);
  for_each_index(removed.size(), [=] ESPDIFF_HD(std::size_t t) { is_removed[t] = was_removed[parent[t]]; });
  surface.source = with_middles(surface.source, split);
  surface.x = with_middles(surface.x, split);
  surface.flow = with_middles(surface.flow, split);
  surface.previous = with_middles(surface.previous, split);
  surface.gradient = with_middles(surface.gradient, split);
  surface.clock = with_middles(surface.clock, split);
  surface.unmatched.resize(surface.x.size(), 0);
  surface.waits.resize(surface.x.size(), 0);
  surface.removed.swap(removed);
  surface.topology = split.topology;
  surface.order = spatial_order(surface.x);
  return split.ends.size();
}

}  // namespace espdiff::ESPDIFF_BACKEND
