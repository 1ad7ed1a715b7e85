// intersections.cu: finds pairs of triangles with overlapping boxes and counts those that intersect: leaf by leaf of
// the tree, or on the CPU in groups of 8 triangles.
#include "cuda/certificate/intersections.h"

#include <cstring>

#include "cuda/certificate/fans.h"
#include "cuda/certificate/triangle_pairs.h"
#include "cuda/device/lanes.h"
#include "cuda/surface/mesh/triangle_tree.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Whether two boxes overlap. Always makes all six comparisons, since branches would be mispredicted too often.
ESPDIFF_INLINE bool overlap(const Box& p, const Box& q) {
  const int x = static_cast<int>(p.lower.x <= q.upper.x) & static_cast<int>(q.lower.x <= p.upper.x);
  const int y = static_cast<int>(p.lower.y <= q.upper.y) & static_cast<int>(q.lower.y <= p.upper.y);
  const int z = static_cast<int>(p.lower.z <= q.upper.z) & static_cast<int>(q.lower.z <= p.upper.z);
  return (x & y & z) != 0;
}

/// Input and output of the search.
struct MeetingSearch {
  TriangleTreeView tree;
  const Corners* vertices;         ///< [place]
  const Box* boxes;                ///< [place]
  const std::uint8_t* degenerate;  ///< [place]
  const std::uint8_t* clear_fan;   ///< [vertex] no two triangles around it intersect
  std::uint32_t* n_met;            ///< [place] number of intersecting pairs with this triangle
};

/// Whether two triangles share a vertex around which none intersect.
ESPDIFF_INLINE bool share_clear_fan(const MeetingSearch& in, const Corners& a, const Corners& b) {
  for (const std::uint32_t v : a.v) {
    if ((v == b.v[0] || v == b.v[1] || v == b.v[2]) && in.clear_fan[v] != 0) return true;
  }
  return false;
}

/// Whether the triangles at two places intersect; if so, counts it for both.
ESPDIFF_HD inline bool meet(const MeetingSearch& in, std::uint32_t p, std::uint32_t q) {
  const Corners vertices_p = in.vertices[p], vertices_q = in.vertices[q];
  if (share_clear_fan(in, vertices_p, vertices_q)) return false;
  const PlacedTriangle first = in.tree.triangles[p];
  if (!triangles_meet(first, make_plane(first.a, first.b, first.c), vertices_p, in.tree.triangles[q], vertices_q))
    return false;
  atomic_increment(&in.n_met[p]);
  atomic_increment(&in.n_met[q]);
  return true;
}

/// Compares the triangles of a leaf with those of another; within one leaf, each pair once.
struct ByLeaves {
  static constexpr std::uint32_t kWidth = 1;  ///< in leaves of the tree

  ESPDIFF_HD std::uint32_t operator()(const MeetingSearch& in, std::uint32_t leaf, std::uint32_t other) const {
    const std::uint32_t n = in.tree.n_triangles;
    const std::uint32_t end = (leaf + 1) * kTrianglesPerLeaf < n ? (leaf + 1) * kTrianglesPerLeaf : n;
    const std::uint32_t other_end = (other + 1) * kTrianglesPerLeaf < n ? (other + 1) * kTrianglesPerLeaf : n;
    std::uint32_t found = 0;
    for (std::uint32_t p = leaf * kTrianglesPerLeaf; p < end; ++p) {
      if (in.degenerate[p] != 0) continue;
      const Box box = in.boxes[p];
      if (!overlap(box, in.tree.boxes[in.tree.n_leaves - 1 + other])) continue;
      for (std::uint32_t q = leaf == other ? p + 1 : other * kTrianglesPerLeaf; q < other_end; ++q) {
        if (in.degenerate[q] == 0 && overlap(box, in.boxes[q]) && meet(in, p, q)) ++found;
      }
    }
    return found;
  }
};

#if !defined(__CUDACC__)

/// The boxes of 8 triangles in the order of the places. Empty ones, of degenerate triangles and beyond the last,
/// overlap nothing.
struct GroupOfBoxes {
  float lower_x[kBlock], lower_y[kBlock], lower_z[kBlock], upper_x[kBlock], upper_y[kBlock], upper_z[kBlock];
};

struct BoxLanes {
  Lanes lower_x, lower_y, lower_z, upper_x, upper_y, upper_z;
};

ESPDIFF_INLINE void load(const GroupOfBoxes& from, BoxLanes& to) { std::memcpy(&to, &from, sizeof to); }

/// In lanes whose box overlaps the other, no side of one lies beyond the opposite side of the other.
ESPDIFF_INLINE LaneMask overlap_lanes(const BoxLanes& a, const Box& b) {
  const Lanes x = larger_lanes<Lanes>(a.lower_x - b.upper.x, b.lower.x - a.upper_x),
              y = larger_lanes<Lanes>(a.lower_y - b.upper.y, b.lower.y - a.upper_y),
              z = larger_lanes<Lanes>(a.lower_z - b.upper.z, b.lower.z - a.upper_z);
  return larger_lanes(x, larger_lanes(y, z)) <= Lanes{};
}

/// Compares the triangles of four neighbouring leaves with those of four others.
struct ByGroups {
  static constexpr std::uint32_t kWidth = kBlock / kTrianglesPerLeaf;
  const GroupOfBoxes* boxes;  ///< [group]

  ESPDIFF_INLINE std::uint32_t operator()(const MeetingSearch& in, std::uint32_t group, std::uint32_t other) const {
    BoxLanes own, others;
    load(boxes[group], own);
    load(boxes[other], others);
    const Box around = in.tree.boxes[in.tree.n_leaves / kWidth - 1 + other];
    std::uint32_t found = 0;
    for (std::uint32_t near = bits_of(overlap_lanes(own, around)); near != 0; near &= near - 1) {
      const std::uint32_t lane = static_cast<std::uint32_t>(__builtin_ctz(near)), p = group * kBlock + lane;
      std::uint32_t hits = bits_of(overlap_lanes(others, in.boxes[p]));
      if (group == other) hits &= ~0U << (lane + 1);
      for (; hits != 0; hits &= hits - 1) {
        if (meet(in, p, other * kBlock + static_cast<std::uint32_t>(__builtin_ctz(hits)))) ++found;
      }
    }
    return found;
  }
};

#endif

/// Number of intersecting pairs of a triangle in this part of the tree with another in it or in a later part.
/// @param compare ByLeaves or ByGroups, whose width is that of a part
template <typename Compare>
ESPDIFF_INLINE std::uint32_t meetings_from(const MeetingSearch& in, const Compare& compare, std::uint32_t part) {
  struct Pending {
    std::uint32_t node, last, width;  ///< `width` parts lie below the node; the last is `last`
  };
  const std::uint32_t n_parts = in.tree.n_leaves / Compare::kWidth;
  const Box box = in.tree.boxes[n_parts - 1 + part];
  Pending stack[32];
  int depth = 0;
  Pending at = {0, n_parts - 1, n_parts};
  std::uint32_t found = 0;
  for (;;) {
    if (at.width == 1) {
      found += compare(in, part, at.last);
      if (depth == 0) return found;
      at = stack[--depth];
      continue;
    }
    const std::uint32_t half = at.width / 2, child = 2 * at.node + 1;
    const bool left = at.last - half >= part && overlap(box, in.tree.boxes[child]);
    const bool right = overlap(box, in.tree.boxes[child + 1]);
    if (!left && !right) {
      if (depth == 0) return found;
      at = stack[--depth];
      continue;
    }
    if (left && right) stack[depth++] = {child + 1, at.last, half};
    at = left ? Pending{child, at.last - half, half} : Pending{child + 1, at.last, half};
  }
}

#if !defined(__CUDACC__)

ESPDIFF_MULTIVERSION std::uint32_t meetings_from_group(const MeetingSearch& in, const ByGroups& compare,
                                                       std::uint32_t group) {
  return meetings_from(in, compare, group);
}

GroupOfBoxes boxes_of_group(const MeetingSearch& in, std::size_t group) {
  GroupOfBoxes lanes;
  for (std::size_t lane = 0; lane < kBlock; ++lane) {
    const std::size_t p = group * kBlock + lane;
    const bool empty = p >= in.tree.n_triangles || in.degenerate[p] != 0;
    const Box box = empty ? Box{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}} : in.boxes[p];
    lanes.lower_x[lane] = box.lower.x;
    lanes.lower_y[lane] = box.lower.y;
    lanes.lower_z[lane] = box.lower.z;
    lanes.upper_x[lane] = box.upper.x;
    lanes.upper_y[lane] = box.upper.y;
    lanes.upper_z[lane] = box.upper.z;
  }
  return lanes;
}

#endif

/// Sum of count(part) over the parts of the tree. Early parts have the most parts after them. Each thread takes
/// one from either end, which balances the load.
template <typename Count>
std::size_t sum_over_parts(std::uint32_t n_parts, Count count) {
  // Into an array first, because a chunk of sum_over() is too much work for one thread.
  Buffer<std::uint32_t> found(n_parts);
  std::uint32_t* const n_found = raw(found);
  for_each_index((n_parts + 1) / 2, [=] ESPDIFF_HD(std::size_t i) {
    const std::uint32_t part = static_cast<std::uint32_t>(i), mirrored = n_parts - 1 - part;
    n_found[part] = count(part);
    if (mirrored != part) n_found[mirrored] = count(mirrored);
  });
  return sum_over<std::size_t>(n_parts, [=] ESPDIFF_HD(std::size_t part) { return std::size_t{n_found[part]}; });
}

struct CountFromLeaf {
  MeetingSearch in;
  ESPDIFF_HD std::uint32_t operator()(std::uint32_t leaf) const { return meetings_from(in, ByLeaves{}, leaf); }
};

std::size_t count_pairs(const MeetingSearch& in, bool by_groups) {
#if !defined(__CUDACC__)
  if (by_groups && in.tree.n_leaves >= ByGroups::kWidth) {
    const std::uint32_t n_groups = in.tree.n_leaves / ByGroups::kWidth;
    Buffer<GroupOfBoxes> groups(n_groups);
    GroupOfBoxes* const boxes = raw(groups);
    for_each_index(n_groups, [=](std::size_t group) { boxes[group] = boxes_of_group(in, group); });
    return sum_over_parts(n_groups,
                          [=](std::uint32_t group) { return meetings_from_group(in, ByGroups{boxes}, group); });
  }
#else
  static_cast<void>(by_groups);
#endif
  return sum_over_parts(in.tree.n_leaves, CountFromLeaf{in});
}

IntersectionReport intersections_in_form(const SurfaceMesh& mesh, bool by_groups) {
  const std::size_t n = mesh.n_triangles();
  const TriangleTree tree = make_triangle_tree(mesh);
  const TriangleTreeView view = tree.view();
  const Corners* const corners = raw(mesh.topology->triangles);
  Buffer<Corners> vertices(n);
  Buffer<Box> boxes(n);
  Buffer<std::uint8_t> degenerate(n);
  Buffer<std::uint32_t> n_met(n);
  Corners* const vertex = raw(vertices);
  Box* const box = raw(boxes);
  std::uint8_t* const no_area = raw(degenerate);
  std::uint32_t* const met = raw(n_met);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t place) {
    vertex[place] = corners[view.order[place]];
    box[place] = box_of(view.triangles[place]);
    no_area[place] = has_no_area(view.triangles[place]) ? 1 : 0;
    met[place] = no_area[place];  // counts as a pair with itself
  });
  Buffer<std::uint8_t> clear_fans(mesh.n_vertices());
  std::uint8_t* const clear_fan = raw(clear_fans);
  const TopologyView topology = mesh.view();
  const Vec4f* const x = raw(mesh.positions);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    clear_fan[v] = fan_has_no_intersection(topology, x, static_cast<std::uint32_t>(v)) ? 1 : 0;
  });
  const MeetingSearch search{view, vertex, box, no_area, clear_fan, met};
  IntersectionReport report;
  report.n_degenerate =
      sum_over<std::size_t>(n, [=] ESPDIFF_HD(std::size_t place) { return std::size_t{no_area[place]}; });
  report.n_pairs = report.n_degenerate + count_pairs(search, by_groups);
  auto flags = std::make_shared<Scalars>();
  flags->values.resize(n);
  float* const flag = raw(flags->values);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t place) { flag[view.order[place]] = met[place] > 0 ? 1.0F : 0.0F; });
  report.intersecting = flags;
  return report;
}

}  // namespace

IntersectionReport self_intersections(const SurfaceMesh& mesh) { return intersections_in_form(mesh, true); }

IntersectionReport self_intersections_leaf_by_leaf(const SurfaceMesh& mesh) {
  return intersections_in_form(mesh, false);
}

}  // namespace espdiff::ESPDIFF_BACKEND
