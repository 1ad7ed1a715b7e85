// triangle_pairs.h: exact test whether two triangles of a mesh intersect.
//
// Triangles are closed sets, so touching is intersecting. Triangles that share a vertex or an edge intersect only if
// they meet elsewhere too. All tests use the exact signs of orientation.h. The caller must exclude triangles without
// area (has_no_area).
#pragma once

#include "cuda/device/orientation.h"
#include "cuda/surface/mesh/mesh.h"
#include "cuda/surface/mesh/triangle_tree.h"

namespace espdiff::ESPDIFF_BACKEND {

ESPDIFF_INLINE Vec3f corner(const PlacedTriangle& t, int i) { return i == 0 ? t.a : i == 1 ? t.b : t.c; }

/// Projects along a coordinate axis.
ESPDIFF_INLINE Vec2f seen_along(int axis, Vec3f p) {
  return axis == 0 ? Vec2f{p.y, p.z} : axis == 1 ? Vec2f{p.z, p.x} : Vec2f{p.x, p.y};
}

/// The first axis along which the triangle does not project to a line; 3 if there is none.
ESPDIFF_HD inline int axis_that_shows(const PlacedTriangle& t) {
  int axis = 0;
  while (axis < 3 && turn(seen_along(axis, t.a), seen_along(axis, t.b), seen_along(axis, t.c)) == 0) ++axis;
  return axis;
}

/// Whether its corners are collinear or not all finite.
ESPDIFF_HD inline bool has_no_area(const PlacedTriangle& t) {
  for (int i = 0; i < 3; ++i) {
    const Vec3f p = corner(t, i);
    if (!is_finite(p.x) || !is_finite(p.y) || !is_finite(p.z)) return true;
  }
  return axis_that_shows(t) == 3;
}

/// Whether p lies in the triangle, in the plane.
ESPDIFF_HD inline bool covers(const Vec2f* triangle, Vec2f p) {
  const int first = turn(triangle[0], triangle[1], p), second = turn(triangle[1], triangle[2], p),
            third = turn(triangle[2], triangle[0], p);
  return (first >= 0 && second >= 0 && third >= 0) || (first <= 0 && second <= 0 && third <= 0);
}

/// Whether two segments cross with the ends of each strictly on either side of the other.
ESPDIFF_HD inline bool cross_inside(Vec2f a, Vec2f b, Vec2f c, Vec2f d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

/// Whether p lies on the segment ab.
ESPDIFF_HD inline bool lies_on(Vec2f p, Vec2f a, Vec2f b) {
  const bool between_x = (a.x <= p.x && p.x <= b.x) || (b.x <= p.x && p.x <= a.x);
  const bool between_y = (a.y <= p.y && p.y <= b.y) || (b.y <= p.y && p.y <= a.y);
  return between_x && between_y && turn(a, b, p) == 0;
}

/// Whether segment st meets the triangle in whose plane it lies. If neither an end of the segment lies in the triangle
/// nor a corner of the triangle on the segment, the segment can only cross an edge.
ESPDIFF_HD ESPDIFF_NOINLINE inline bool meets_in_plane(Vec3f s, Vec3f t, const PlacedTriangle& triangle) {
  const int axis = axis_that_shows(triangle);
  const Vec2f corners[3] = {seen_along(axis, triangle.a), seen_along(axis, triangle.b), seen_along(axis, triangle.c)};
  const Vec2f from = seen_along(axis, s), to = seen_along(axis, t);
  if (covers(corners, from) || covers(corners, to)) return true;
  for (int i = 0; i < 3; ++i) {
    if (cross_inside(from, to, corners[i], corners[(i + 1) % 3]) || lies_on(corners[i], from, to)) return true;
  }
  return false;
}

/// Whether the segment st meets the triangle.
/// @param side_s, side_t  sides of the triangle's plane
ESPDIFF_HD ESPDIFF_NOINLINE inline bool segment_meets(Vec3f s, int side_s, Vec3f t, int side_t,
                                                      const PlacedTriangle& triangle) {
  if (side_s * side_t > 0) return false;
  if (side_s == 0 && side_t == 0) return meets_in_plane(s, t, triangle);
  // The line meets the plane in one point, which is inside if it passes all edges on the same side.
  const int first = orientation(s, t, triangle.a, triangle.b);
  const int second = orientation(s, t, triangle.b, triangle.c);
  if (first * second < 0) return false;
  const int third = orientation(s, t, triangle.c, triangle.a);
  return first * third >= 0 && second * third >= 0;
}

/// Two triangles that share no vertex.
ESPDIFF_HD inline bool apart_meet(const PlacedTriangle& p, const Plane& plane_p, const PlacedTriangle& q) {
  const int q_sides[3] = {side_of(plane_p, q.a), side_of(plane_p, q.b), side_of(plane_p, q.c)};
  if (q_sides[0] != 0 && q_sides[0] == q_sides[1] && q_sides[0] == q_sides[2]) return false;
  const Plane plane_q = make_plane(q.a, q.b, q.c);
  const int p_sides[3] = {side_of(plane_q, p.a), side_of(plane_q, p.b), side_of(plane_q, p.c)};
  if (p_sides[0] != 0 && p_sides[0] == p_sides[1] && p_sides[0] == p_sides[2]) return false;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (segment_meets(corner(q, i), q_sides[i], corner(q, j), q_sides[j], p)) return true;
    if (segment_meets(corner(p, i), p_sides[i], corner(p, j), p_sides[j], q)) return true;
  }
  return false;
}

/// Two triangles of which corner i of p and corner j of q are one vertex. If they share more than that vertex, the
/// opposite edge of one of them meets the other triangle.
ESPDIFF_HD inline bool vertex_sharers_meet(const PlacedTriangle& p, const Plane& plane_p, int i,
                                           const PlacedTriangle& q, int j) {
  const Vec3f q1 = corner(q, (j + 1) % 3), q2 = corner(q, (j + 2) % 3);
  const int side_q1 = side_of(plane_p, q1), side_q2 = side_of(plane_p, q2);
  if (side_q1 * side_q2 > 0) return false;
  const Vec3f p1 = corner(p, (i + 1) % 3), p2 = corner(p, (i + 2) % 3);
  const Plane plane_q = make_plane(q.a, q.b, q.c);
  const int side_p1 = side_of(plane_q, p1), side_p2 = side_of(plane_q, p2);
  if (side_p1 * side_p2 > 0) return false;
  return segment_meets(q1, side_q1, q2, side_q2, p) || segment_meets(p1, side_p1, p2, side_p2, q);
}

/// Two triangles with a common edge: they meet elsewhere only if folded flat onto each other.
/// @param i  the corner of p that is not on the edge  @param apex  the corresponding corner of the other
ESPDIFF_HD inline bool edge_sharers_meet(const PlacedTriangle& p, const Plane& plane_p, int i, Vec3f apex) {
  if (side_of(plane_p, apex) != 0) return false;
  const int axis = axis_that_shows(p);
  const Vec2f a = seen_along(axis, corner(p, (i + 1) % 3)), b = seen_along(axis, corner(p, (i + 2) % 3));
  return turn(a, b, seen_along(axis, corner(p, i))) == turn(a, b, seen_along(axis, apex));
}

/// Two triangles with area, by the vertex indices that they share.
/// @param plane_p  the plane of p, which is compared with several triangles
ESPDIFF_HD inline bool triangles_meet(const PlacedTriangle& p, const Plane& plane_p, const Corners& vertices_p,
                                      const PlacedTriangle& q, const Corners& vertices_q) {
  int n_shared = 0, shared_p = 0, shared_q = 0, sum_p = 0, sum_q = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (vertices_p.v[i] != vertices_q.v[j]) continue;
      ++n_shared;
      shared_p = i;
      shared_q = j;
      sum_p += i;
      sum_q += j;
    }
  }
  if (n_shared == 0) return apart_meet(p, plane_p, q);
  if (n_shared == 1) return vertex_sharers_meet(p, plane_p, shared_p, q, shared_q);
  if (n_shared == 2) return edge_sharers_meet(p, plane_p, 3 - sum_p, corner(q, 3 - sum_q));
  return true;  // the same triangle twice
}

}  // namespace espdiff::ESPDIFF_BACKEND
