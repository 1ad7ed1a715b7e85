// clip_surface.cpp: parts of a cut surface add up to the whole and meet in the same vertices.
#include "vmdplugin/bridge/clip_surface.h"

#include <doctest/doctest.h>

#include <cmath>

namespace espdiff {
namespace {

/// A square of n x n cells in the plane z = 0, two triangles each.
struct Square {
  std::vector<Vec3f> positions, normals;
  std::vector<Triangle> triangles;
};

Square square(int n) {
  Square s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      s.positions.push_back({static_cast<float>(i), static_cast<float>(j), 0});
      s.normals.push_back({0, 0, 1});
    }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return s;
}

double area(const ClippedSurface& surface, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& t : triangles) {
    const Vec3f a = surface.positions()[t[0]], b = surface.positions()[t[1]], c = surface.positions()[t[2]];
    sum += 0.5 * static_cast<double>((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }
  return sum;
}

}  // namespace

TEST_CASE("both sides of a line have their exact areas, and share its vertices") {
  const Square s = square(4);
  ClippedSurface surface(s.positions, s.normals);
  std::vector<float> x;
  for (const Vec3f p : s.positions) x.push_back(p.x);
  const auto field = surface.add_field(x);
  std::vector<Triangle> left, right;
  for (const Triangle& t : s.triangles) {
    const Polygon polygon(t.begin(), t.end());
    ClippedSurface::append_fan(surface.keep_below(polygon, field, 1.25F), left);
    ClippedSurface::append_fan(surface.keep_above(polygon, field, 1.25F), right);
  }
  CHECK(area(surface, left) == doctest::Approx(5.0));
  CHECK(area(surface, right) == doctest::Approx(11.0));
  // The line crosses 5 horizontal edges and 4 diagonals, once each.
  CHECK(surface.positions().size() == s.positions.size() + 9);
  for (std::size_t v = s.positions.size(); v < surface.positions().size(); ++v) {
    CHECK(surface.positions()[v].x == doctest::Approx(1.25F));
    CHECK(surface.normals()[v].z == doctest::Approx(1.0F));
    CHECK(surface.field(field)[v] == 1.25F);
  }
}

TEST_CASE("a polygon on one side of the level stays whole, or goes") {
  const Square s = square(1);
  ClippedSurface surface(s.positions, s.normals);
  const auto field = surface.add_field({0, 0, 0, 0});
  const Polygon polygon(s.triangles[0].begin(), s.triangles[0].end());
  CHECK(surface.keep_below(polygon, field, 1) == polygon);
  CHECK(surface.keep_above(polygon, field, 1).empty());
  CHECK(surface.keep_above({}, field, 1).empty());
  CHECK(surface.positions().size() == 4);
}

TEST_CASE("the border of a flagged region is a smooth line through its middle") {
  const int n = 20;
  const Square s = square(n);
  std::vector<std::uint8_t> flags;
  for (const Triangle& t : s.triangles) {
    float x = 0;
    for (const std::uint32_t v : t) x += s.positions[v].x / 3;
    flags.push_back(x > 10 ? 1 : 0);
  }
  const std::vector<float> share = flagged_share(s.triangles, flags, s.positions.size());
  for (std::size_t v = 0; v < share.size(); ++v) {
    const Vec3f p = s.positions[v];
    if (p.x < 6) CHECK(share[v] == 0.0F);
    if (p.x > 14) CHECK(share[v] == doctest::Approx(1.0F));
    if (p.y > 5 && p.y < 15 && p.x == 10.0F) CHECK(share[v] == doctest::Approx(0.5F).epsilon(0.2));
  }
  CHECK(flagged_share(s.triangles, {}, s.positions.size()) == std::vector<float>(s.positions.size(), 0.0F));
}

}  // namespace espdiff
