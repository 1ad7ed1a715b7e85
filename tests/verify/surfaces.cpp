// surfaces.cpp: the verifier's own geometry on shapes whose values are known.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "verify/target_surface.h"
#include "verify/triangle_meetings.h"

using espdiff::GaussianAtoms;
using espdiff::Triangle;
using espdiff::Vec3d;

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Tetrahedron {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;

  void add(Vec3d shift) {
    const auto n = static_cast<std::uint32_t>(positions.size());
    for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{4, 0, 0}, Vec3d{0, 4, 0}, Vec3d{0, 0, 4}})
      positions.push_back(p + shift);
    for (const Triangle& t : {Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
      triangles.push_back({n + t[0], n + t[1], n + t[2]});
  }
};

}  // namespace

TEST_SUITE_BEGIN("verify");

TEST_CASE("one Gaussian's surface is the sphere where it has the isovalue") {
  const double width = 1.7, isovalue = 0.5, radius = width * std::sqrt(2 * std::log(2.0));
  const GaussianAtoms atoms({{3, -1, 2}}, {width});
  const auto sphere = atoms.surface(isovalue, 0.1);
  CHECK(espdiff::area_of(sphere) == doctest::Approx(4 * kPi * radius * radius).epsilon(2e-3));
  Vec3d gradient;
  CHECK(atoms.at({3 + radius, -1, 2}, gradient) == doctest::Approx(isovalue));
  CHECK(gradient.x == doctest::Approx(-radius / (width * width) * isovalue));
  const auto larger = GaussianAtoms({{3, -1, 2}}, {2 * width}).surface(isovalue, 0.1);
  const auto apart = espdiff::distances(sphere, larger, 1);
  CHECK(apart.mean == doctest::Approx(radius).epsilon(0.01));
  CHECK(apart.beyond == doctest::Approx(1.0));
}

TEST_CASE("closed cavities are left out") {
  std::vector<Vec3d> shell;
  for (int i = 0; i < 600; ++i) {  // a golden spiral
    const double z = 1 - (2 * i + 1) / 600.0, angle = 2.399963 * i, r = std::sqrt(1 - z * z);
    shell.push_back({8 * r * std::cos(angle), 8 * r * std::sin(angle), 8 * z});
  }
  const auto surface = GaussianAtoms(shell, std::vector<double>(shell.size(), 1.0)).surface(0.5, 0.5);
  CHECK(espdiff::area_of(surface) > 4 * kPi * 64);
  CHECK(espdiff::area_of(surface) < 4 * kPi * 140);  // the inner side would add some 300 A^2
}

TEST_CASE("the strongest label is that of the nearer of equal atoms, and -1 out of reach") {
  const GaussianAtoms atoms({{0, 0, 0}, {9, 9, 9}, {4, 0, 0}}, {1, 0, 1});
  CHECK(atoms.strongest({1, 0, 0}, {5, 6, 7}) == 5);
  CHECK(atoms.strongest({3, 0, 0}, {5, 6, 7}) == 7);
  CHECK(atoms.strongest({9, 9, 9}, {5, 6, 7}) == -1);
  CHECK_THROWS_AS(GaussianAtoms({{0, 0, 0}}, {0.0}), espdiff::InputError);
}

TEST_CASE("crossing triangles are counted, neighbours and separate ones are not") {
  Tetrahedron shapes;
  shapes.add({});
  CHECK(espdiff::count_meetings(shapes.positions, shapes.triangles) == 0);
  shapes.add({20, 0, 0});
  CHECK(espdiff::count_meetings(shapes.positions, shapes.triangles) == 0);
  // The corner at (1.1, 0.9, 0.8) lies inside: its three faces cross the first one's slanted face.
  shapes.add({1.1, 0.9, 0.8});
  CHECK(espdiff::count_meetings(shapes.positions, shapes.triangles) == 3);
  shapes.positions[5] = shapes.positions[4];  // two triangles of the second one lose their area
  CHECK(espdiff::count_meetings(shapes.positions, shapes.triangles) == 5);
}

TEST_CASE("a surface that a damaged file has at one point is not counted through") {
  std::vector<espdiff::Triangle> triangles;
  for (std::uint32_t t = 0; t < 30000; ++t) triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  const auto begun = std::chrono::steady_clock::now();
  CHECK(espdiff::count_meetings(std::vector<Vec3d>(90000, Vec3d{1, 2, 3}), triangles) > 1000);
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(20));
}

TEST_CASE("the loops end when the user asks for it") {
  Tetrahedron pair;
  pair.add({0, 0, 0});
  pair.add({1, 1, 1});
  const GaussianAtoms atoms({{0, 0, 0}, {2, 0, 0}}, {1.5, 1.5});
  espdiff::Progress progress;
  const espdiff::CancelScope scope(progress);
  CHECK_NOTHROW(espdiff::count_meetings(pair.positions, pair.triangles));
  progress.request_cancel();
  CHECK_THROWS_AS(espdiff::count_meetings(pair.positions, pair.triangles), espdiff::Cancelled);
  CHECK_THROWS_AS(atoms.surface(0.5, 0.5), espdiff::Cancelled);
}

TEST_SUITE_END();
