// unwrap.cpp: molecules wrapped at a periodic cell's border become whole, wherever the border lies.
#include "align/geometry/unwrap.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "align/geometry/superpose.h"
#include "base/error.h"

using espdiff::shortest_image;
using espdiff::unwrapped;
using espdiff::Vec3d;

namespace {

using Edges = std::array<Vec3d, 3>;
constexpr Edges kSkewed = {Vec3d{60, 0, 0}, Vec3d{21, 55, 0}, Vec3d{-18, 14, 58}};

/// Numbers between -1 and 1.
struct Random {
  std::uint64_t state = 7;
  double operator()() {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 33) / 1073741824.0 - 1;
  }
};

/// A coil of C-alpha atoms 3.8 A apart.
std::vector<Vec3d> coil(int n, Vec3d from) {
  std::vector<Vec3d> atoms;
  for (int i = 0; i < n; ++i) {
    const double angle = 1.745 * i;
    atoms.push_back(from + Vec3d{2.3 * std::cos(angle), 2.3 * std::sin(angle), 1.5 * i});
  }
  return atoms;
}

/// Moves each atom to a random image.
std::vector<Vec3d> scattered(std::vector<Vec3d> atoms, const Edges& edges) {
  Random random;
  for (Vec3d& p : atoms) {
    for (const Vec3d& edge : edges) p += std::round(1.4 * random()) * edge;
  }
  return atoms;
}

/// The largest change of a distance to the first atom.
double distortion(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, norm((a[i] - a[0]) - (b[i] - b[0])));
  return most;
}

}  // namespace

TEST_CASE("the shortest image is the shortest of all near ones") {
  Random random;
  for (int n = 0; n < 200; ++n) {
    const Vec3d v{150 * random(), 150 * random(), 150 * random()};
    const double found = norm(shortest_image(v, kSkewed));
    double best = norm(v);
    for (int i = -5; i <= 5; ++i) {
      for (int j = -5; j <= 5; ++j) {
        for (int k = -5; k <= 5; ++k)
          best = std::min(best, norm(v + double(i) * kSkewed[0] + double(j) * kSkewed[1] + double(k) * kSkewed[2]));
      }
    }
    CHECK(found == doctest::Approx(best).epsilon(1e-12));
  }
}

TEST_CASE("a chain scattered over images becomes whole, and a whole one stays unchanged") {
  const auto whole = coil(60, {1, 2, 3});  // 89 A long, longer than the cell
  CHECK(distortion(whole, unwrapped(scattered(whole, kSkewed), kSkewed, {})) < 1e-9);
  CHECK(distortion(whole, unwrapped(whole, kSkewed, {})) < 1e-9);
}

TEST_CASE("two chains are placed as in the reference, though another image is nearer") {
  auto whole = coil(20, {0, 0, 0});
  for (const Vec3d& p : coil(12, {41, 0, 5})) whole.push_back(p);  // nearer at 41 - 60
  // Rotated and moved in the meantime, and slightly bent.
  std::vector<Vec3d> later = whole;
  const double c = std::cos(0.4), s = std::sin(0.4);
  for (Vec3d& p : later) p = {c * p.x - s * p.y + 17, s * p.x + c * p.y - 9, p.z + 0.01 * p.x};
  CHECK(distortion(later, unwrapped(scattered(later, kSkewed), kSkewed, whole)) < 1e-9);
  // Without a reference the second chain takes the nearest image.
  const auto alone = unwrapped(scattered(whole, kSkewed), kSkewed, {});
  CHECK(norm(alone[25] - alone[0]) < norm(whole[25] - whole[0]));
}

TEST_CASE("molecules that cannot be unwrapped are refused") {
  CHECK(unwrapped({}, kSkewed, {}).empty());
  CHECK_THROWS_AS(unwrapped({{1, 2, 3}}, kSkewed, {{1, 2, 3}, {4, 5, 6}}), espdiff::InputError);
  CHECK_THROWS_AS(unwrapped({{1, 2, 3}}, {Vec3d{1, 0, 0}, Vec3d{2, 0, 0}, Vec3d{0, 0, 1}}, {}), espdiff::InputError);
}
