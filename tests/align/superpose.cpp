// superpose.cpp: known motions are recovered, reflections refused, and the principal frame does not depend on the
// position.
#include "align/geometry/superpose.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.h"
#include "support/test_data.h"

using namespace espdiff;
using espdiff_test::message_of;

namespace {

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

IndexPairs one_to_one(std::size_t n) {
  IndexPairs pairs;
  for (std::size_t i = 0; i < n; ++i) pairs.emplace_back(i, i);
  return pairs;
}

/// Points of unequal spread along the axes, skewed, so that no two principal axes are alike.
std::vector<Vec3d> cloud(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3d> points(n);
  for (Vec3d& p : points) {
    const double u = normal(random), v = normal(random), w = normal(random);
    p = {9 * u + 2 * u * u, 5 * v + v * v, 2 * w + 0.5 * w * w};
  }
  return points;
}

/// Rotation by `angle` about (1, 2, 3), then a translation.
RigidTransform motion(double angle, Vec3d translation) {
  const double length = std::sqrt(14.0), x = 1 / length, y = 2 / length, z = 3 / length;
  const double c = std::cos(angle), s = std::sin(angle), t = 1 - c;
  return {{t * x * x + c, t * x * y - s * z, t * x * z + s * y, t * x * y + s * z, t * y * y + c, t * y * z - s * x,
           t * x * z - s * y, t * y * z + s * x, t * z * z + c},
          translation};
}

std::vector<Vec3d> moved(const std::vector<Vec3d>& points, const RigidTransform& transform) {
  std::vector<Vec3d> result;
  for (const Vec3d& p : points) result.push_back(transform.apply(p));
  return result;
}

double determinant(const RigidTransform& transform) {
  const double* r = transform.rotation;
  return dot(Vec3d{r[0], r[1], r[2]}, cross(Vec3d{r[3], r[4], r[5]}, Vec3d{r[6], r[7], r[8]}));
}

double largest_difference(const RigidTransform& a, const RigidTransform& b) {
  double largest = 0;
  for (int i = 0; i < 9; ++i) largest = std::max(largest, std::fabs(a.rotation[i] - b.rotation[i]));
  return largest;
}

double largest_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
  return largest;
}

}  // namespace

TEST_CASE("a known rigid motion is recovered to 1e-12") {
  const auto points = cloud(100, 1);
  for (const double angle : {0.0, 1e-6, 0.4, 2.0, 3.141592653589793}) {
    const RigidTransform truth = motion(angle, {30, -20, 110});
    const Superposition found = superpose(points, moved(points, truth), one_to_one(points.size()));
    CHECK(largest_difference(found.transform, truth) < 1e-12);
    CHECK(norm(found.transform.translation - truth.translation) < 1e-11);
    CHECK(found.rmsd_A < 1e-12);
    CHECK(determinant(found.transform) == doctest::Approx(1).epsilon(1e-14));
  }
}

TEST_CASE("a mirror image gives a rotation, not a reflection") {
  const auto points = cloud(50, 2);
  std::vector<Vec3d> mirrored;
  for (const Vec3d& p : points) mirrored.push_back({p.x, p.y, -p.z});
  const Superposition found = superpose(points, mirrored, one_to_one(points.size()));
  CHECK(determinant(found.transform) == doctest::Approx(1).epsilon(1e-14));
  CHECK(found.rmsd_A > 1);
}

TEST_CASE("three atoms suffice, though they lie in a plane") {
  const std::vector<Vec3d> points = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}};
  const RigidTransform truth = motion(1.1, {1, 2, 3});
  const Superposition found = superpose(points, moved(points, truth), one_to_one(3));
  CHECK(largest_difference(found.transform, truth) < 1e-12);
}

TEST_CASE("no nearby motion has a lower RMSD, and the RMSD is that of the moved points") {
  const auto moving = cloud(60, 3);
  auto fixed = moved(moving, motion(0.7, {4, 5, 6}));
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0, 0.8);
  for (Vec3d& p : fixed) p += Vec3d{normal(random), normal(random), normal(random)};
  const auto pairs = one_to_one(moving.size());
  const Superposition best = superpose(moving, fixed, pairs);
  CHECK(best.rmsd_A == doctest::Approx(rmsd(moved(moving, best.transform), fixed, pairs)).epsilon(1e-12));
  for (int trial = 0; trial < 300; ++trial) {
    const RigidTransform nudge =
        compose(motion(0.01 * normal(random), {0.02 * normal(random), 0.02 * normal(random), 0}), best.transform);
    CHECK(rmsd(moved(moving, nudge), fixed, pairs) >= best.rmsd_A);
  }
}

TEST_CASE("only paired points determine the superposition") {
  const auto points = cloud(20, 5);
  const RigidTransform truth = motion(2.5, {-7, 0, 1});
  auto fixed = moved(points, truth);
  std::reverse(fixed.begin(), fixed.end());
  fixed[19] = {1e3, 1e3, 1e3};
  IndexPairs pairs;
  for (std::size_t i = 1; i < 20; ++i) pairs.emplace_back(i, 19 - i);
  CHECK(largest_difference(superpose(points, fixed, pairs).transform, truth) < 1e-12);
}

TEST_CASE("points that determine no rotation are refused with a remedy") {
  const std::vector<Vec3d> line = {{0, 0, 0}, {1, 1, 2}, {2, 2, 4}, {5, 5, 10}}, point(4, Vec3d{1, 2, 3});
  const auto shape = cloud(4, 6);
  for (const auto* degenerate : {&line, &point}) {
    CHECK_THROWS_AS(superpose(*degenerate, shape, one_to_one(4)), GeometryError);
    const std::string message = message_of([&] { superpose(shape, *degenerate, one_to_one(4)); });
    CHECK(message.find("lie on a line or in a point") != std::string::npos);
    CHECK(message.find("align none") != std::string::npos);
  }
  const std::string too_few = message_of([&] { superpose(shape, shape, one_to_one(2)); });
  CHECK(too_few.find("at least 3 pairs of atoms, 2 were given") != std::string::npos);
  std::vector<Vec3d> broken = shape;
  broken[1].y = std::nan("");
  CHECK(message_of([&] { superpose(broken, shape, one_to_one(4)); }).find("not finite") != std::string::npos);
}

TEST_CASE("RMSD is the root of the mean squared distance") {
  const std::vector<Vec3d> a = {{0, 0, 0}, {1, 0, 0}}, b = {{0, 0, 3}, {1, 4, 0}};
  CHECK(rmsd(a, b, one_to_one(2)) == doctest::Approx(std::sqrt(12.5)));
  CHECK_THROWS_AS(rmsd(a, b, {}), GeometryError);
}

TEST_CASE("inverse and compose act like the motions") {
  const RigidTransform a = motion(0.8, {1, 2, 3}), b = motion(-2.1, {-5, 9, 0.5});
  const Vec3d p{3, -4, 5};
  CHECK(norm(compose(a, b).apply(p) - a.apply(b.apply(p))) < 1e-14 * 50);
  CHECK(norm(inverse(a).apply(a.apply(p)) - p) < 1e-14 * 50);
}

TEST_CASE("the principal frame depends on the shape only, not on rigid motion or atom order") {
  const auto points = cloud(200, 8);
  const auto reference = moved(points, principal_frame(points));
  for (const double angle : {0.3, 1.9, 3.0}) {
    const auto elsewhere = moved(points, motion(angle, {50, 60, -70}));
    CHECK(largest_distance(moved(elsewhere, principal_frame(elsewhere)), reference) < 1e-10);
  }
  auto shuffled = points;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(9));
  CHECK(largest_difference(principal_frame(shuffled), principal_frame(points)) < 1e-12);
}

TEST_CASE("the principal frame is right-handed, centred, and ordered by extent") {
  const auto points = cloud(200, 10);
  const RigidTransform frame = principal_frame(points);
  CHECK(determinant(frame) == doctest::Approx(1).epsilon(1e-13));
  Vec3d sum{}, squares{}, cubes{};
  double mixed = 0;
  for (const Vec3d& p : moved(points, frame)) {
    sum += p;
    squares += Vec3d{p.x * p.x, p.y * p.y, p.z * p.z};
    cubes += Vec3d{p.x * p.x * p.x, p.y * p.y * p.y, p.z * p.z * p.z};
    mixed += p.x * p.y;
  }
  CHECK(norm(sum) < 1e-9);
  CHECK(std::fabs(mixed) < 1e-9 * squares.x);
  CHECK(squares.x > squares.y);
  CHECK(squares.y > squares.z);
  CHECK(cubes.x > 0);
  CHECK(cubes.y > 0);
}

TEST_CASE("few or symmetric points also have a right-handed frame") {
  const std::vector<Vec3d> one = {{1, 2, 3}}, two = {{0, 0, 0}, {0, 0, 2}};
  const std::vector<Vec3d> cross_shape = {{1, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 0, 3}, {0, 0, -3}};
  for (const auto* points : {&one, &two, &cross_shape}) {
    CHECK(determinant(principal_frame(*points)) == doctest::Approx(1).epsilon(1e-13));
  }
  CHECK(norm(principal_frame(one).apply(one[0])) < 1e-14);
  CHECK(message_of([] { principal_frame({}); }).find("without atoms") != std::string::npos);
}
