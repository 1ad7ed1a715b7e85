// triangle_tree.cu: builds the tree: order along the Hilbert curve, leaves, boxes level by level.
#include "cuda/surface/mesh/triangle_tree.h"

#include <cfloat>
#include <cmath>

#include "cuda/device/hilbert_curve.h"
#include "cuda/device/sort.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

ESPDIFF_INLINE Box empty_box() { return {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}}; }

ESPDIFF_INLINE Box join(Box a, Box b) {
  return {{smaller(a.lower.x, b.lower.x), smaller(a.lower.y, b.lower.y), smaller(a.lower.z, b.lower.z)},
          {larger(a.upper.x, b.upper.x), larger(a.upper.y, b.upper.y), larger(a.upper.z, b.upper.z)}};
}

/// Bounding box that sum_over() can add (union).
struct BoxSum {
  Box box = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
  ESPDIFF_HD BoxSum& operator+=(const BoxSum& other) {
    box = join(box, other.box);
    return *this;
  }
};

/// In element 0.
Buffer<BoxSum> mesh_box(const SurfaceMesh& mesh) {
  const Vec4f* const x = raw(mesh.positions);
  return sum_on_device<BoxSum>(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    BoxSum point;
    point.box = {x[v].xyz(), x[v].xyz()};
    return point;
  });
}

}  // namespace

TriangleTree make_triangle_tree(const SurfaceMesh& mesh) {
  const std::uint32_t n = static_cast<std::uint32_t>(mesh.n_triangles());
  const Buffer<BoxSum> bounds = mesh_box(mesh);
  const Box* const bound = &raw(bounds)->box;
  const Corners* const corners = raw(mesh.topology->triangles);
  const Vec4f* const x = raw(mesh.positions);

  TriangleTree tree;
  tree.order.resize(n);
  Buffer<std::uint32_t> codes(n);
  std::uint32_t* const code = raw(codes);
  std::uint32_t* const index = raw(tree.order);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t t) {
    const Vec3f sum = x[corners[t].v[0]].xyz() + x[corners[t].v[1]].xyz() + x[corners[t].v[2]].xyz();
    code[t] = hilbert_code(hilbert_scale(bound->lower, bound->upper) * ((1.0F / 3.0F) * sum - bound->lower));
    index[t] = static_cast<std::uint32_t>(t);
  });
  sort_by_key(codes, tree.order, kHilbertBits);

  tree.n_leaves = 1;
  while (tree.n_leaves * kTrianglesPerLeaf < n) tree.n_leaves *= 2;
  tree.triangles.resize(n);
  tree.boxes.resize(2 * static_cast<std::size_t>(tree.n_leaves) - 1);
  PlacedTriangle* const placed = raw(tree.triangles);
  tree.spheres.resize(n);
  const std::uint32_t* const order = raw(tree.order);
  Box* const boxes = raw(tree.boxes);
  Vec4f* const spheres = raw(tree.spheres);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t place) {
    const Corners t = corners[order[place]];
    const PlacedTriangle corner = {x[t.v[0]].xyz(), x[t.v[1]].xyz(), x[t.v[2]].xyz()};
    const Vec3f centre = (1.0F / 3.0F) * (corner.a + corner.b + corner.c);
    placed[place] = corner;
    spheres[place] =
        make_vec4(centre, larger(norm(corner.a - centre), larger(norm(corner.b - centre), norm(corner.c - centre))));
  });
  const std::size_t n_leaves = tree.n_leaves;
  for_each_index(n_leaves, [=] ESPDIFF_HD(std::size_t leaf) {
    Box box = empty_box();
    for (std::size_t t = leaf * kTrianglesPerLeaf; t < (leaf + 1) * kTrianglesPerLeaf && t < n; ++t)
      box = join(box, box_of(placed[t]));
    boxes[n_leaves - 1 + leaf] = box;
  });
  for (std::size_t width = n_leaves / 2; width > 0; width /= 2) {
    for_each_index(width, [=] ESPDIFF_HD(std::size_t i) {
      const std::size_t node = width - 1 + i;
      boxes[node] = join(boxes[2 * node + 1], boxes[2 * node + 2]);
    });
  }
  return tree;
}

}  // namespace espdiff::ESPDIFF_BACKEND
