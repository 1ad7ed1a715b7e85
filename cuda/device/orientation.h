// orientation.h: exact orientation predicates: the side of a plane, or of a line, on which a point lies.
//
// A filter in double precision decides nearly every case: the determinant and a bound on its rounding error. The
// remaining cases add the determinant's terms exactly, as expansions (Shewchuk, Discrete Comput. Geom. 18, 305 (1997),
// section 2: sums of doubles whose bits do not overlap). This is simple for floats: the product of two is exact in a
// double, the product of three is two doubles, and neither overflows nor underflows.
#pragma once

#include <cmath>

#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

#define ESPDIFF_NOINLINE __attribute__((noinline))

/// Half a unit in the last place of 1: the largest relative error of one double operation.
constexpr double kRounding = 1.0 / 9007199254740992.0;

ESPDIFF_INLINE int sign_of(double x) { return (x > 0 ? 1 : 0) - (x < 0 ? 1 : 0); }

/// An exact sum of doubles: nonoverlapping nonzero terms in order of size.
class ExactSum {
 public:
  /// Adds a term, starting with the smallest: each partial sum carries on to the next term and leaves its rounding
  /// error behind (Shewchuk, theorem 10).
  ESPDIFF_HD void add(double term) {
    int kept = 0;
    for (int i = 0; i < n_terms_; ++i) {
      const double sum = term + terms_[i], added = sum - term;
      const double error = (term - (sum - added)) + (terms_[i] - added);
      if (error != 0) terms_[kept++] = error;
      term = sum;
    }
    if (term != 0) terms_[kept++] = term;
    n_terms_ = kept;
  }
  /// The last term is larger than all others together.
  ESPDIFF_HD int sign() const { return n_terms_ == 0 ? 0 : sign_of(terms_[n_terms_ - 1]); }

 private:
  static constexpr int kMaxTerms = 48;  // two for each product of an orientation
  double terms_[kMaxTerms];
  int n_terms_ = 0;
};

/// Adds the product of three floats.
ESPDIFF_HD inline void add_product(ExactSum& sum, double a, double b, double c) {
  const double ab = a * b, abc = ab * c;
  sum.add(fma(ab, c, -abc));
  sum.add(abc);
}

/// Adds factor * det(p, q, r), with factor 1 or -1.
ESPDIFF_HD inline void add_determinant(ExactSum& sum, double factor, Vec3d p, Vec3d q, Vec3d r) {
  add_product(sum, factor * p.x, q.y, r.z);
  add_product(sum, -factor * p.x, q.z, r.y);
  add_product(sum, factor * p.y, q.z, r.x);
  add_product(sum, -factor * p.y, q.x, r.z);
  add_product(sum, factor * p.z, q.x, r.y);
  add_product(sum, -factor * p.z, q.y, r.x);
}

/// The exact sign of det(b - a, c - a, d - a). Rarely needed, so kept out of line to save registers in the common path.
ESPDIFF_HD ESPDIFF_NOINLINE inline int exact_orientation(Vec3f a, Vec3f b, Vec3f c, Vec3f d) {
  const Vec3d p = static_cast<Vec3d>(a), q = static_cast<Vec3d>(b), r = static_cast<Vec3d>(c),
              s = static_cast<Vec3d>(d);
  ExactSum sum;  // the 4 x 4 determinant with a column of ones, expanded along that column
  add_determinant(sum, 1, q, r, s);
  add_determinant(sum, -1, p, r, s);
  add_determinant(sum, 1, p, q, s);
  add_determinant(sum, -1, p, q, r);
  return sum.sign();
}

/// The plane through three points, precomputed for many queries.
struct Plane {
  Vec3f a, b, c;
  Vec3d normal;  ///< (b - a) x (c - a), rounded
  Vec3d size;    ///< the same with every term positive: scales the rounding error of `normal`
};

ESPDIFF_INLINE Plane make_plane(Vec3f a, Vec3f b, Vec3f c) {
  const Vec3d u = static_cast<Vec3d>(b) - static_cast<Vec3d>(a), v = static_cast<Vec3d>(c) - static_cast<Vec3d>(a);
  const Vec3d first = {u.y * v.z, u.z * v.x, u.x * v.y}, second = {u.z * v.y, u.x * v.z, u.y * v.x};
  return {a,
          b,
          c,
          first - second,
          {fabs(first.x) + fabs(second.x), fabs(first.y) + fabs(second.y), fabs(first.z) + fabs(second.z)}};
}

/// The sign of det(b - a, c - a, d - a): 1 on the side that the normal points to (from there a, b, c are
/// counter-clockwise), -1 on the other side, 0 exactly in the plane.
ESPDIFF_INLINE int side_of(const Plane& plane, Vec3f d) {
  // Each of the six products passes eight roundings: three differences, two products, three sums. Two more cover the
  // rounding of the bound itself.
  const Vec3d w = static_cast<Vec3d>(d) - static_cast<Vec3d>(plane.a);
  const double determinant = dot(plane.normal, w);
  const double bound =
      10 * kRounding * (plane.size.x * fabs(w.x) + plane.size.y * fabs(w.y) + plane.size.z * fabs(w.z));
  if (determinant > bound) return 1;
  if (-determinant > bound) return -1;
  return exact_orientation(plane.a, plane.b, plane.c, d);
}

/// The sign of det(b - a, c - a, d - a).
ESPDIFF_INLINE int orientation(Vec3f a, Vec3f b, Vec3f c, Vec3f d) { return side_of(make_plane(a, b, c), d); }

struct Vec2f {
  float x, y;
};

/// turn() evaluated exactly: products of two floats are exact in double.
ESPDIFF_HD ESPDIFF_NOINLINE inline int exact_turn(double ax, double ay, double bx, double by, double cx, double cy) {
  ExactSum sum;
  sum.add(ax * by);
  sum.add(-ay * bx);
  sum.add(bx * cy);
  sum.add(-by * cx);
  sum.add(cx * ay);
  sum.add(-cy * ax);
  return sum.sign();
}

/// 1 for a left turn a, b, c; -1 for a right turn; 0 exactly on a line.
ESPDIFF_HD inline int turn(Vec2f a, Vec2f b, Vec2f c) {
  const double ax = static_cast<double>(a.x), ay = static_cast<double>(a.y), bx = static_cast<double>(b.x),
               by = static_cast<double>(b.y), cx = static_cast<double>(c.x), cy = static_cast<double>(c.y);
  const double left = (bx - ax) * (cy - ay), right = (by - ay) * (cx - ax);
  const double bound = 6 * kRounding * (fabs(left) + fabs(right));  // four roundings, plus two for the bound
  if (left - right > bound) return 1;
  if (right - left > bound) return -1;
  return exact_turn(ax, ay, bx, by, cx, cy);
}

}  // namespace espdiff::ESPDIFF_BACKEND
