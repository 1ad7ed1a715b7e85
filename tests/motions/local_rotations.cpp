// local_rotations.cpp: neighbourhoods that rotate as a whole, that have too few atoms, and the reverse path.
#include <doctest/doctest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "motions/local_rotations.h"
#include "support/random.h"

using namespace espdiff_test;
using espdiff::MovingAtom;
using espdiff::Screw;
using espdiff::Vec3d;

namespace {

const Vec3d kAxis{2.0 / 3, -1.0 / 3, 2.0 / 3};

/// Atoms as densely packed as a protein's, 0.1 / A^3, in a cube.
std::vector<MovingAtom> packed(double half_side, std::uint64_t seed) {
  Random random(seed);
  std::vector<MovingAtom> paths(static_cast<std::size_t>(0.8 * half_side * half_side * half_side));
  for (MovingAtom& path : paths) {
    path.start = path.end = random.in_box(half_side);
    path.start_width = path.end_width = 1.5;
  }
  return paths;
}

Screw turn_by(double angle) {
  Screw screw;
  screw.axis = kAxis;
  screw.angle = angle;
  screw.shift = 3.0 * kAxis;
  return screw;
}

/// The largest difference of a rotation from the expected one.
template <typename Expected>
double farthest_from(const std::vector<MovingAtom>& paths, Expected expected) {
  double farthest = 0;
  for (std::size_t i = 0; i < paths.size(); ++i)
    farthest = std::max(farthest, norm(paths[i].own_rotation - expected(i)));
  return farthest;
}

}  // namespace

TEST_SUITE_BEGIN("local_turns");

TEST_CASE("a rotation of the whole rotates all neighbourhoods, less at corners") {
  std::vector<MovingAtom> paths = packed(12, 1);
  const Screw screw = turn_by(0.6);
  for (MovingAtom& path : paths) path.end = screw.apply(path.start, 1);
  set_local_rotations(paths);
  for (const MovingAtom& path : paths) {
    const double along = dot(path.own_rotation, kAxis);
    CHECK(along > 0.15);
    CHECK(along < 0.6);
    if (std::max({std::fabs(path.start.x), std::fabs(path.start.y), std::fabs(path.start.z)}) > 3) continue;
    CHECK(norm(path.own_rotation - 0.6 * kAxis) < 0.1);
  }
}

TEST_CASE("no rotation where atoms rest, translate together, or follow their domain") {
  std::vector<MovingAtom> paths = packed(8, 2);
  const auto none = [](std::size_t) { return Vec3d{}; };
  set_local_rotations(paths);
  CHECK(farthest_from(paths, none) < 1e-6);
  for (MovingAtom& path : paths) path.end = path.start + Vec3d{1, 2, 3};
  set_local_rotations(paths);
  CHECK(farthest_from(paths, none) < 1e-6);
  const Screw screw = turn_by(0.6);
  for (std::size_t i = 0; i < paths.size(); i += 2) {
    paths[i].motion = screw;
    paths[i].end = screw.apply(paths[i].start, 1);
  }
  set_local_rotations(paths);
  CHECK(farthest_from(paths, none) < 1e-6);
}

TEST_CASE("the reverse path rotates by the inverse, also relative to a domain's motion") {
  std::vector<MovingAtom> there = packed(8, 3);
  Random random(4);
  const Screw screw = turn_by(0.5);
  Screw inverse = screw;
  inverse.angle = -screw.angle;
  inverse.shift = -1.0 * screw.shift;
  for (MovingAtom& path : there) {
    path.motion = screw;
    path.end = screw.apply(path.start, 1) + random.in_box(5);
  }
  std::vector<MovingAtom> back = there;
  for (MovingAtom& path : back) {
    std::swap(path.start, path.end);
    path.motion = inverse;
  }
  set_local_rotations(there);
  set_local_rotations(back);
  double turned = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    turned = std::max(turned, norm(there[i].own_rotation));
    for (const double time : {0.0, 0.3, 1.0}) CHECK(norm(there[i].spin_at(time) + back[i].spin_at(1 - time)) < 1e-6);
  }
  CHECK(turned > 0.05);
}

TEST_CASE("rotations of collinear, few or fading atoms are damped") {
  std::vector<MovingAtom> paths(3);
  const Screw screw = turn_by(1);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    paths[i].start = {1.5 * static_cast<double>(i), 0, 0};
    paths[i].end = screw.apply(paths[i].start, 1);
  }
  set_local_rotations(paths);
  CHECK(farthest_from(paths, [](std::size_t) { return Vec3d{}; }) < 0.05);
  // Fading atoms have no weight, but rotate with the others.
  std::vector<MovingAtom> all = packed(8, 5);
  for (MovingAtom& path : all) path.end = screw.apply(path.start, 1);
  const std::size_t n = all.size();
  std::vector<MovingAtom> with_fading = all;
  MovingAtom fading = all[0];
  fading.at_end = false;
  with_fading.push_back(fading);
  fading.end = {50, 0, 0};
  with_fading.push_back(fading);
  set_local_rotations(all);
  set_local_rotations(with_fading);
  for (std::size_t i = 0; i < n; ++i) CHECK(with_fading[i].own_rotation == all[i].own_rotation);
  CHECK(norm(with_fading[n].own_rotation - all[0].own_rotation) < 1e-12);
  CHECK(norm(with_fading[n + 1].own_rotation) == 0);
}

TEST_CASE("atoms of another motion have no weight, whatever they share lanes with") {
  const std::vector<MovingAtom> all = packed(9, 7);
  Random random(8);
  std::vector<MovingAtom> mixed = all;
  std::vector<MovingAtom> parts[3];
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    const std::size_t part = i % 7 == 0 ? 0 : i % 3 == 0 ? 1 : 2;
    mixed[i].motion = turn_by(0.3 * static_cast<double>(part));
    mixed[i].end = mixed[i].motion.apply(mixed[i].start + random.in_box(2), 1);
    parts[part].push_back(mixed[i]);
  }
  set_local_rotations(mixed);
  for (std::vector<MovingAtom>& part : parts) set_local_rotations(part);
  std::size_t next[3] = {}, n_same = 0;
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    const std::size_t part = i % 7 == 0 ? 0 : i % 3 == 0 ? 1 : 2;
    n_same += parts[part][next[part]++].own_rotation == mixed[i].own_rotation ? 1 : 0;
  }
  CHECK(n_same == mixed.size());
  CHECK(norm(mixed[0].own_rotation) > 0);
}

TEST_CASE("rotations have the same bits at any number of threads, and can be cancelled") {
  std::vector<MovingAtom> one = packed(30, 6);
  const Screw screw = turn_by(0.6);
  for (std::size_t i = 0; i < one.size(); ++i) one[i].end = screw.apply(one[i].start, i % 3 == 0 ? 0.5 : 1);
  REQUIRE(one.size() > 3 * 4096);
  std::vector<MovingAtom> many = one;
  const int n_threads = omp_get_max_threads();
  omp_set_num_threads(1);
  set_local_rotations(one);
  for (const int n : {2, 4}) {
    omp_set_num_threads(n);
    set_local_rotations(many);
    bool is_same = true;
    for (std::size_t i = 0; i < one.size(); ++i) is_same = is_same && many[i].own_rotation == one[i].own_rotation;
    CHECK_MESSAGE(is_same, n);
  }
  omp_set_num_threads(n_threads);
  espdiff::Progress cancelled;
  cancelled.request_cancel();
  CHECK_THROWS_AS(set_local_rotations(many, cancelled), espdiff::Cancelled);
}

TEST_SUITE_END();
