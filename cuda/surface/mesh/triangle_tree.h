// triangle_tree.h: nearest triangle to a point, by a bounding-volume hierarchy.
//
// Triangles are ordered along the Hilbert curve of their centroids and stored four to a leaf of a complete binary tree,
// whose boxes are built level by level. Without pointers or insertion order, the tree is a function of the mesh alone.
// After the linear BVH of Lauterbach et al., Comput. Graph. Forum 28, 375 (2009), with a complete tree as the
// hierarchy.
#pragma once

#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

constexpr std::uint32_t kTrianglesPerLeaf = 4;

struct Box {
  Vec3f lower, upper;
};

struct PlacedTriangle {
  Vec3f a, b, c;
};

ESPDIFF_INLINE Box box_of(const PlacedTriangle& t) {
  return {
      {smaller(t.a.x, smaller(t.b.x, t.c.x)), smaller(t.a.y, smaller(t.b.y, t.c.y)),
       smaller(t.a.z, smaller(t.b.z, t.c.z))},
      {larger(t.a.x, larger(t.b.x, t.c.x)), larger(t.a.y, larger(t.b.y, t.c.y)), larger(t.a.z, larger(t.b.z, t.c.z))}};
}

struct TriangleTreeView {
  const Box* boxes;                 ///< [node] children of n are 2n+1 and 2n+2; leaves are the last n_leaves nodes
  const PlacedTriangle* triangles;  ///< [place] in leaf order
  const Vec4f* spheres;             ///< [place] bounding sphere: centroid, and radius in w
  const std::uint32_t* order;       ///< [place] the triangle's index in the mesh
  std::uint32_t n_leaves;           ///< a power of two
  std::uint32_t n_triangles;
};

struct TriangleTree {
  Buffer<Box> boxes;
  Buffer<PlacedTriangle> triangles;
  Buffer<Vec4f> spheres;
  Buffer<std::uint32_t> order;
  std::uint32_t n_leaves = 0;

  TriangleTreeView view() const {
    return {raw(boxes), raw(triangles), raw(spheres),
            raw(order), n_leaves,       static_cast<std::uint32_t>(triangles.size())};
  }
};

TriangleTree make_triangle_tree(const SurfaceMesh& mesh);

/// Squared distance of p to a triangle (degenerate ones count as segments or points). The nearest point lies in the
/// face, on an edge or at a corner; if the foot on the plane falls outside the face, it lies on one of the three edges.
ESPDIFF_INLINE float squared_distance_to_segment(Vec3f p, Vec3f a, Vec3f b) {
  const Vec3f ab = b - a, ap = p - a;
  const float length_squared = dot(ab, ab), inverse = length_squared > 0 ? 1.0F / length_squared : 0.0F;
  const Vec3f d = ap - smaller(larger(dot(ap, ab) * inverse, 0.0F), 1.0F) * ab;
  return dot(d, d);
}

ESPDIFF_INLINE float squared_distance_to_triangle(Vec3f p, const PlacedTriangle& t) {
  const Vec3f n = cross(t.b - t.a, t.c - t.a);
  const float nn = dot(n, n);
  const Vec3f pa = p - t.a, pb = p - t.b, pc = p - t.c;
  const bool over_face = nn > 0 && dot(pa, cross(n, t.b - t.a)) >= 0 && dot(pb, cross(n, t.c - t.b)) >= 0 &&
                         dot(pc, cross(n, t.a - t.c)) >= 0;
  if (over_face) {
    const float height = dot(pa, n);
    return height * height * (1.0F / nn);
  }
  return smaller(squared_distance_to_segment(p, t.a, t.b),
                 smaller(squared_distance_to_segment(p, t.b, t.c), squared_distance_to_segment(p, t.c, t.a)));
}

ESPDIFF_INLINE float squared_distance_to_box(Vec3f p, const Box& box) {
  const float dx = larger(larger(box.lower.x - p.x, p.x - box.upper.x), 0.0F);
  const float dy = larger(larger(box.lower.y - p.y, p.y - box.upper.y), 0.0F);
  const float dz = larger(larger(box.lower.z - p.z, p.z - box.upper.z), 0.0F);
  return dx * dx + dy * dy + dz * dz;
}

/// The triangle nearest to a point: its place in leaf order, and the squared distance to it.
struct NearestTriangle {
  std::uint32_t place;
  float squared_distance;
};

/// Whether a box at this squared distance may hold a nearer triangle. A triangle's own distance can be rounded below
/// its box's, so the box gets some slack: what is found does not depend on the order of the search.
ESPDIFF_INLINE bool may_be_nearer(float box_squared_distance, float squared_distance) {
  return box_squared_distance < 1.001F * squared_distance + 1e-9F;
}

/// Nearest triangle of the tree. `guess` is the place of any triangle: a closer guess visits less of the tree and does
/// not change the distance.
ESPDIFF_INLINE NearestTriangle nearest_triangle(const TriangleTreeView& tree, Vec3f p, std::uint32_t guess) {
  struct Pending {
    std::uint32_t node;
    float distance;
  };
  Pending stack[32];
  int depth = 0;
  NearestTriangle nearest{guess, squared_distance_to_triangle(p, tree.triangles[guess])};
  float nearest_distance = sqrtf(nearest.squared_distance);
  std::uint32_t node = 0;
  float node_distance = squared_distance_to_box(p, tree.boxes[0]);
  for (;;) {
    if (may_be_nearer(node_distance, nearest.squared_distance)) {
      if (node + 1 < tree.n_leaves) {
        const std::uint32_t left = 2 * node + 1;
        const float d_left = squared_distance_to_box(p, tree.boxes[left]),
                    d_right = squared_distance_to_box(p, tree.boxes[left + 1]);
        const bool left_first = d_left <= d_right;
        stack[depth++] = {left_first ? left + 1 : left, left_first ? d_right : d_left};
        node = left_first ? left : left + 1;
        node_distance = left_first ? d_left : d_right;
        continue;
      }
      const std::uint32_t begin = (node + 1 - tree.n_leaves) * kTrianglesPerLeaf;
      const std::uint32_t end =
          begin + kTrianglesPerLeaf < tree.n_triangles ? begin + kTrianglesPerLeaf : tree.n_triangles;
      for (std::uint32_t t = begin; t < end; ++t) {
        // The bounding sphere rules out most triangles of a leaf; the slack covers rounding.
        const Vec4f sphere = tree.spheres[t];
        const float reach = 1.0001F * (nearest_distance + sphere.w);
        const Vec3f to_centre = p - sphere.xyz();
        if (dot(to_centre, to_centre) > reach * reach) continue;
        const float d = squared_distance_to_triangle(p, tree.triangles[t]);
        if (d < nearest.squared_distance) {
          nearest = {t, d};
          nearest_distance = sqrtf(d);
        }
      }
    }
    do {
      if (depth == 0) return nearest;
      --depth;
    } while (!may_be_nearer(stack[depth].distance, nearest.squared_distance));
    node = stack[depth].node;
    node_distance = stack[depth].distance;
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
