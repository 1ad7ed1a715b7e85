// distances_to_triangles.cu: nearest triangles of points, one by one or in blocks of lanes.
#include "cuda/surface/distances_to_triangles.h"

#include <cstring>

#include "cuda/device/spatial_order.h"
#include "cuda/surface/density/point_sums.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Points that one thread takes one after the other: the triangle of the point before is a good guess. A GPU has
/// threads for all.
#if defined(ESPDIFF_BACKEND_CUDA)
constexpr std::size_t kRun = 1;
#else
constexpr std::size_t kRun = 32;
#endif

/// A triangle near a point, by their places: both follow the same curve through nearly the same box.
ESPDIFF_INLINE std::uint32_t guess_at(std::size_t place, std::size_t n_points, std::size_t n_triangles) {
  return static_cast<std::uint32_t>(place * (n_triangles - 1) / n_points);
}

#if !defined(__CUDACC__)

struct LaneVector {
  Lanes x, y, z;
};

struct NearestSearch {
  TriangleTreeView tree;
  PointList points;
  float* distances;
};

ESPDIFF_INLINE LaneVector from_corner(const LaneVector& p, const Vec3f& corner) {
  return {p.x - corner.x, p.y - corner.y, p.z - corner.z};
}
ESPDIFF_INLINE Lanes dot_lanes(const LaneVector& a, const Vec3f& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ESPDIFF_INLINE Lanes outside_lanes(const Lanes& x, float lower, float upper) {
  return larger_lanes<Lanes>(larger_lanes<Lanes>(lower - x, x - upper), Lanes{});
}

// Inlined into each instruction set's version, unlike those of Vec3.
ESPDIFF_INLINE float dot_here(const Vec3f& a, const Vec3f& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
ESPDIFF_INLINE Vec3f cross_here(const Vec3f& a, const Vec3f& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
ESPDIFF_INLINE Vec3f minus(const Vec3f& a, const Vec3f& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// squared_distance_to_segment() per lane; a segment without length gives t = 0.
ESPDIFF_INLINE Lanes segment_lanes(const LaneVector& ap, const Vec3f& ab) {
  const float length_squared = dot_here(ab, ab);
  const float inverse = length_squared > 0 ? 1.0F / length_squared : 0.0F;
  const Lanes t = smaller_lanes<Lanes>(larger_lanes<Lanes>(dot_lanes(ap, ab) * inverse, Lanes{}), Lanes{} + 1.0F);
  const Lanes dx = ap.x - t * ab.x, dy = ap.y - t * ab.y, dz = ap.z - t * ab.z;
  return dx * dx + dy * dy + dz * dz;
}

/// squared_distance_to_triangle() per lane.
ESPDIFF_INLINE Lanes triangle_lanes(const LaneVector& p, const PlacedTriangle& t) {
  const Vec3f ab = minus(t.b, t.a), bc = minus(t.c, t.b), ca = minus(t.a, t.c);
  const Vec3f n = cross_here(ab, minus(t.c, t.a));
  const float nn = dot_here(n, n);
  const LaneVector pa = from_corner(p, t.a), pb = from_corner(p, t.b), pc = from_corner(p, t.c);
  const Lanes edges = smaller_lanes(segment_lanes(pa, ab), smaller_lanes(segment_lanes(pb, bc), segment_lanes(pc, ca)));
  if (!(nn > 0)) return edges;
  // Negative where the foot on the plane lies beside the face.
  const Lanes inside = smaller_lanes(dot_lanes(pa, cross_here(n, ab)),
                                     smaller_lanes(dot_lanes(pb, cross_here(n, bc)), dot_lanes(pc, cross_here(n, ca))));
  const Lanes height = dot_lanes(pa, n);
  const LaneMask beside = inside < Lanes{};
  return chosen<LaneMask, Lanes>(beside, edges, height * height * (1.0F / nn));
}

/// squared_distance_to_box() per lane.
ESPDIFF_INLINE Lanes box_lanes(const LaneVector& p, const Box& box) {
  const Lanes dx = outside_lanes(p.x, box.lower.x, box.upper.x), dy = outside_lanes(p.y, box.lower.y, box.upper.y),
              dz = outside_lanes(p.z, box.lower.z, box.upper.z);
  return dx * dx + dy * dy + dz * dz;
}

/// may_be_nearer() for any lane.
ESPDIFF_INLINE bool any_may_be_nearer(const Lanes& box, const Lanes& nearest) {
  return any_lane(box < 1.001F * nearest + 1e-9F);
}

/// Goes through the nodes that may hold a nearer triangle for any lane; the child nearer to the first lane comes first.
/// @param guess the place of any triangle; a near one saves time. Becomes that of one near to these points.
ESPDIFF_INLINE Lanes nearest_of_lanes(const TriangleTreeView& tree, const LaneVector& p, std::uint32_t& guess) {
  struct Pending {
    std::uint32_t node;
    Lanes distance;
  };
  Pending stack[32];
  int depth = 0;
  Lanes nearest = triangle_lanes(p, tree.triangles[guess]);
  std::uint32_t node = 0;
  Lanes distance{};
  for (;;) {
    if (any_may_be_nearer(distance, nearest)) {
      if (node + 1 < tree.n_leaves) {
        const std::uint32_t left = 2 * node + 1;
        const Lanes of_left = box_lanes(p, tree.boxes[left]), of_right = box_lanes(p, tree.boxes[left + 1]);
        const bool left_first = of_left[0] <= of_right[0];
        stack[depth].node = left_first ? left + 1 : left;
        stack[depth++].distance = left_first ? of_right : of_left;
        node = left_first ? left : left + 1;
        distance = left_first ? of_left : of_right;
        continue;
      }
      const std::uint32_t begin = (node + 1 - tree.n_leaves) * kTrianglesPerLeaf;
      const std::uint32_t end = std::min(begin + kTrianglesPerLeaf, tree.n_triangles);
      for (std::uint32_t t = begin; t < end; ++t) {
        if (!any_may_be_nearer(box_lanes(p, box_of(tree.triangles[t])), nearest)) continue;
        const Lanes found = triangle_lanes(p, tree.triangles[t]);
        if (found[kBlock - 1] < nearest[kBlock - 1]) guess = t;
        nearest = smaller_lanes(found, nearest);
      }
    }
    do {
      if (depth == 0) return nearest;
      --depth;
    } while (!any_may_be_nearer(stack[depth].distance, nearest));
    node = stack[depth].node;
    distance = stack[depth].distance;
  }
}

ESPDIFF_INLINE void search_block(const NearestSearch& in, std::size_t begin, std::uint32_t& guess) {
  const std::size_t end = std::min(begin + kBlock, in.points.n);
  float x[kBlock], y[kBlock], z[kBlock];
  for (std::size_t lane = 0; lane < kBlock; ++lane) {
    const Vec3f point = in.points.points[in.points.list[std::min(begin + lane, end - 1)]].xyz();
    x[lane] = point.x;
    y[lane] = point.y;
    z[lane] = point.z;
  }
  LaneVector p;
  std::memcpy(&p.x, x, sizeof x);
  std::memcpy(&p.y, y, sizeof y);
  std::memcpy(&p.z, z, sizeof z);
  const Lanes nearest = nearest_of_lanes(in.tree, p, guess);
  for (std::size_t lane = 0; begin + lane < end; ++lane)
    in.distances[in.points.list[begin + lane]] = sqrtf(nearest[lane]);
}

ESPDIFF_MULTIVERSION void search_blocks(const NearestSearch& in, std::size_t begin, std::size_t end) {
  std::uint32_t guess = guess_at(begin, in.points.n, in.tree.n_triangles);
  for (std::size_t block = begin; block < end; block += kBlock) search_block(in, block, guess);
}

#endif

}  // namespace

Buffer<float> distances_point_by_point(const TriangleTree& tree, const Buffer<Vec4f>& points) {
  const TriangleTreeView view = tree.view();
  const std::size_t n = points.size();
  const Buffer<std::uint32_t> order = spatial_order(points);
  Buffer<float> distances(n);
  const Vec4f* const x = raw(points);
  const std::uint32_t* const list = raw(order);
  float* const distance = raw(distances);
  for_each_index((n + kRun - 1) / kRun, [=] ESPDIFF_HD(std::size_t run) {
    std::uint32_t guess = guess_at(run * kRun, n, view.n_triangles);
    for (std::size_t i = run * kRun; i < (run + 1) * kRun && i < n; ++i) {
      const NearestTriangle nearest = nearest_triangle(view, x[list[i]].xyz(), guess);
      distance[list[i]] = sqrtf(nearest.squared_distance);
      guess = nearest.place;
    }
  });
  return distances;
}

Buffer<float> distances_to_triangles(const TriangleTree& tree, const Buffer<Vec4f>& points) {
#if defined(__CUDACC__)
  return distances_point_by_point(tree, points);
#else
  const Buffer<std::uint32_t> order = spatial_order(points);
  Buffer<float> distances(points.size());
  const NearestSearch in{tree.view(), {raw(points), raw(order), points.size()}, raw(distances)};
  for_all_blocks(points.size(), in, search_blocks, search_blocks);
  return distances;
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
