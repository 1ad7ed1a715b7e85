// intersections.cu: finds pairs of triangles with overlapping boxes, leaf by leaf of the tree, and counts those that
// intersect.
#include "cuda/certificate/intersections.h"

#include "cuda/certificate/triangle_pairs.h"
#include "cuda/surface/triangle_tree.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Inline, because smaller() and larger() would be calls on the host.
ESPDIFF_INLINE float least(float a, float b, float c) { return a < b ? (a < c ? a : c) : (b < c ? b : c); }
ESPDIFF_INLINE float largest(float a, float b, float c) { return a > b ? (a > c ? a : c) : (b > c ? b : c); }

ESPDIFF_INLINE Box box_around(const PlacedTriangle& t) {
  return {{least(t.a.x, t.b.x, t.c.x), least(t.a.y, t.b.y, t.c.y), least(t.a.z, t.b.z, t.c.z)},
          {largest(t.a.x, t.b.x, t.c.x), largest(t.a.y, t.b.y, t.c.y), largest(t.a.z, t.b.z, t.c.z)}};
}

/// Whether two boxes overlap. Always makes all six comparisons, since branches would be mispredicted too often.
ESPDIFF_INLINE bool overlap(const Box& p, const Box& q) {
  const int x = static_cast<int>(p.lower.x <= q.upper.x) & static_cast<int>(q.lower.x <= p.upper.x);
  const int y = static_cast<int>(p.lower.y <= q.upper.y) & static_cast<int>(q.lower.y <= p.upper.y);
  const int z = static_cast<int>(p.lower.z <= q.upper.z) & static_cast<int>(q.lower.z <= p.upper.z);
  return (x & y & z) != 0;
}

/// Input and output of the search.
struct Search {
  TriangleTreeView tree;
  const Corners* vertices;         ///< [place]
  const Box* boxes;                ///< [place]
  const std::uint8_t* degenerate;  ///< [place]
  std::uint32_t* n_met;            ///< [place] number of intersecting pairs with this triangle
};

/// Compares the triangles of a leaf with those of another; within one leaf, each pair once.
ESPDIFF_HD inline std::uint32_t meetings_of_leaves(const Search& in, std::uint32_t leaf, std::uint32_t other) {
  const std::uint32_t n = in.tree.n_triangles;
  const std::uint32_t end = (leaf + 1) * kTrianglesPerLeaf < n ? (leaf + 1) * kTrianglesPerLeaf : n;
  const std::uint32_t other_end = (other + 1) * kTrianglesPerLeaf < n ? (other + 1) * kTrianglesPerLeaf : n;
  std::uint32_t found = 0;
  for (std::uint32_t p = leaf * kTrianglesPerLeaf; p < end; ++p) {
    if (in.degenerate[p] != 0) continue;
    const Box box = in.boxes[p];
    if (!overlap(box, in.tree.boxes[in.tree.n_leaves - 1 + other])) continue;
    const PlacedTriangle first = in.tree.triangles[p];
    const Plane plane = make_plane(first.a, first.b, first.c);
    for (std::uint32_t q = leaf == other ? p + 1 : other * kTrianglesPerLeaf; q < other_end; ++q) {
      if (in.degenerate[q] != 0 || !overlap(box, in.boxes[q])) continue;
      const PlacedTriangle second = in.tree.triangles[q];
      if (!triangles_meet(first, plane, in.vertices[p], second, in.vertices[q])) continue;
      ++found;
      atomic_increment(&in.n_met[p]);
      atomic_increment(&in.n_met[q]);
    }
  }
  return found;
}

/// Number of intersecting pairs of a triangle in this leaf with another in it or in a later leaf.
ESPDIFF_HD inline std::uint32_t meetings_from_leaf(const Search& in, std::uint32_t leaf) {
  struct Pending {
    std::uint32_t node, last_leaf, width;  ///< `width` leaves lie below the node; the last is `last_leaf`
  };
  const std::uint32_t n_leaves = in.tree.n_leaves;
  const Box box = in.tree.boxes[n_leaves - 1 + leaf];
  Pending stack[32];
  int depth = 0;
  Pending at = {0, n_leaves - 1, n_leaves};
  std::uint32_t found = 0;
  for (;;) {
    if (at.width == 1) {
      found += meetings_of_leaves(in, leaf, at.last_leaf);
      if (depth == 0) return found;
      at = stack[--depth];
      continue;
    }
    const std::uint32_t half = at.width / 2, child = 2 * at.node + 1;
    const bool left = at.last_leaf - half >= leaf && overlap(box, in.tree.boxes[child]);
    const bool right = overlap(box, in.tree.boxes[child + 1]);
    if (!left && !right) {
      if (depth == 0) return found;
      at = stack[--depth];
      continue;
    }
    if (left && right) stack[depth++] = {child + 1, at.last_leaf, half};
    at = left ? Pending{child, at.last_leaf - half, half} : Pending{child + 1, at.last_leaf, half};
  }
}

}  // namespace

IntersectionReport self_intersections(const SurfaceMesh& mesh) {
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
    box[place] = box_around(view.triangles[place]);
    no_area[place] = has_no_area(view.triangles[place]) ? 1 : 0;
    met[place] = no_area[place];  // counts as a pair with itself
  });
  const Search search{view, vertex, box, no_area, met};
  IntersectionReport report;
  report.n_degenerate =
      sum_over<std::size_t>(n, [=] ESPDIFF_HD(std::size_t place) { return std::size_t{no_area[place]}; });
  // Per leaf into an array first, because a chunk of sum_over() is too much work for one thread.
  Buffer<std::uint32_t> found(view.n_leaves);
  std::uint32_t* const n_found = raw(found);
  // Early leaves have the most leaves after them. Each thread takes one from either end, which balances the load.
  for_each_index((view.n_leaves + 1) / 2, [=] ESPDIFF_HD(std::size_t i) {
    const std::uint32_t leaf = static_cast<std::uint32_t>(i), mirrored = search.tree.n_leaves - 1 - leaf;
    n_found[leaf] = meetings_from_leaf(search, leaf);
    if (mirrored != leaf) n_found[mirrored] = meetings_from_leaf(search, mirrored);
  });
  report.n_pairs = report.n_degenerate + sum_over<std::size_t>(view.n_leaves, [=] ESPDIFF_HD(std::size_t leaf) {
                     return std::size_t{n_found[leaf]};
                   });
  auto flags = std::make_shared<Scalars>();
  flags->values.resize(n);
  float* const flag = raw(flags->values);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t place) { flag[view.order[place]] = met[place] > 0 ? 1.0F : 0.0F; });
  report.intersecting = flags;
  return report;
}

}  // namespace espdiff::ESPDIFF_BACKEND
