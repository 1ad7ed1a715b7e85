// vector.cpp: vectors and rigid transforms.
#include "base/vector.h"

#include <doctest/doctest.h>

#include "base/types.h"

using espdiff::RigidTransform;
using espdiff::Vec3d;
using espdiff::Vec4f;

TEST_SUITE_BEGIN("vectors");

TEST_CASE("products and norms") {
  const Vec3d a{1, 2, 3}, b{-4, 5, 0.5};
  CHECK(dot(a, b) == 7.5);
  CHECK(cross(a, b) == Vec3d{-14, -12.5, 13});
  CHECK(dot(cross(a, b), a) == 0);
  CHECK(norm(Vec3d{3, 4, 12}) == 13);
  CHECK(2.0 * a - b == Vec3d{6, -1, 5.5});
  Vec3d c = a;
  c += b;
  CHECK(c == Vec3d{-3, 7, 3.5});
  for (int axis = 0; axis < 3; ++axis) CHECK(a[axis] == axis + 1);
  CHECK(static_cast<Vec3d>(static_cast<espdiff::Vec3f>(a)) == a);
}

TEST_CASE("four components are one aligned load") {
  static_assert(sizeof(Vec4f) == 16 && alignof(Vec4f) == 16, "fields are read as one vector");
  const Vec4f sum = 2.0F * Vec4f{1, 2, 3, 4} - espdiff::make_vec4({1, 1, 1}, 1) + Vec4f{0, 0, 0, 5};
  CHECK(sum.xyz() == espdiff::Vec3f{1, 3, 5});
  CHECK(sum.w == 12);
}

TEST_CASE("a rigid transform rotates first, then translates") {
  RigidTransform quarter;  // about z
  quarter.rotation[0] = 0;
  quarter.rotation[1] = -1;
  quarter.rotation[3] = 1;
  quarter.rotation[4] = 0;
  quarter.translation = {10, 0, 0};
  CHECK(quarter.apply({1, 2, 3}) == Vec3d{8, 1, 3});
  CHECK(quarter.rotate({1, 2, 3}) == Vec3d{-2, 1, 3});
  CHECK(RigidTransform{}.apply({1, 2, 3}) == Vec3d{1, 2, 3});
}

TEST_CASE("a lattice counts its points beyond 32 bits") {
  espdiff::Lattice lattice;
  lattice.size = {3000, 2000, 1000};
  CHECK(lattice.n_points() == 6000000000ULL);
}

TEST_SUITE_END();
