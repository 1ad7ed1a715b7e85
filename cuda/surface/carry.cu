// carry.cu: finds the nearest point on a surface for each point and maps it to the image by barycentric coordinates.
#include "cuda/surface/carry.h"

#include <cmath>

#include "base/error.h"
#include "cuda/surface/mesh/triangle_tree.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Points processed consecutively: neighbours in the list are neighbours in space.
constexpr std::size_t kVerticesPerRun = 32;

/// Weights of a triangle's corners.
struct Barycentric {
  float a, b, c;
};

ESPDIFF_INLINE float along(Vec3f p, Vec3f from, Vec3f to) {
  const Vec3f edge = to - from;
  const float square = dot(edge, edge);
  return square > 0 ? smaller(larger(dot(p - from, edge) / square, 0.0F), 1.0F) : 0.0F;
}

/// The point of a triangle nearest to p: the foot if it lies in the face, otherwise the nearest point on an edge.
ESPDIFF_INLINE Barycentric nearest_point(Vec3f p, const PlacedTriangle& t) {
  const Vec3f n = cross(t.b - t.a, t.c - t.a);
  const float nn = dot(n, n);
  if (nn > 0) {
    const float a = dot(cross(t.c - t.b, p - t.b), n) / nn, b = dot(cross(t.a - t.c, p - t.c), n) / nn;
    const float c = 1.0F - a - b;
    if (a >= 0 && b >= 0 && c >= 0) return {a, b, c};
  }
  const float ab = along(p, t.a, t.b), bc = along(p, t.b, t.c), ca = along(p, t.c, t.a);
  const Barycentric candidates[3] = {{1.0F - ab, ab, 0.0F}, {0.0F, 1.0F - bc, bc}, {ca, 0.0F, 1.0F - ca}};
  int nearest = 0;
  float least = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3f d = p - (candidates[i].a * t.a + candidates[i].b * t.b + candidates[i].c * t.c);
    if (i > 0 && dot(d, d) >= least) continue;
    least = dot(d, d);
    nearest = i;
  }
  return candidates[nearest];
}

}  // namespace

std::shared_ptr<SurfaceMesh> carry(const SurfaceMesh& points, const SurfaceMesh& surface, const SurfaceMesh& image,
                                   float max_distance_A) {
  if (surface.n_vertices() != image.n_vertices() || surface.n_triangles() != image.n_triangles())
    throw GeometryError("carry: the surface and its image differ in topology");
  const TriangleTree tree_of_surface = make_triangle_tree(surface);
  const TriangleTreeView tree = tree_of_surface.view();
  auto carried = std::make_shared<SurfaceMesh>();
  carried->topology = points.topology;
  const std::size_t n = points.n_vertices();
  carried->positions.resize(n);
  const Corners* const corners = raw(surface.topology->triangles);
  const Vec4f *const from = raw(points.positions), *const to = raw(image.positions);
  Vec4f* const out = raw(carried->positions);
  for_each_index((n + kVerticesPerRun - 1) / kVerticesPerRun, [=] ESPDIFF_HD(std::size_t run) {
    std::uint32_t guess = 0;
    for (std::size_t v = run * kVerticesPerRun; v < (run + 1) * kVerticesPerRun && v < n; ++v) {
      const Vec3f p = from[v].xyz();
      const NearestTriangle nearest = nearest_triangle(tree, p, guess);
      guess = nearest.place;
      const Barycentric at = nearest_point(p, tree.triangles[guess]);
      const Corners c = corners[tree.order[guess]];
      const Vec3f there = at.a * to[c.v[0]].xyz() + at.b * to[c.v[1]].xyz() + at.c * to[c.v[2]].xyz();
      const bool near = nearest.squared_distance <= max_distance_A * max_distance_A;
      out[v] = make_vec4(near ? there : Vec3f{NAN, NAN, NAN}, 0.0F);
    }
  });
  return carried;
}

}  // namespace espdiff::ESPDIFF_BACKEND
