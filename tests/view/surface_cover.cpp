// surface_cover.cpp: what pictures draw where a mapping left the surface unmatched.
#include "scene/surface_cover.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace espdiff;  // NOLINT: a test

namespace {

constexpr int kSide = 9;

/// A flat square of 9 x 9 vertices, moved up by 2 A; its middle is unmatched, and lost.
SurfaceFile torn_sheet(std::vector<Vec3f>& start, int side = kSide, int half = 2) {
  SurfaceFile sheet;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const bool is_lost = std::abs(x - side / 2) < half && std::abs(y - side / 2) < half;
      start.push_back({static_cast<float>(x), static_cast<float>(y), 0});
      sheet.positions.push_back(is_lost ? Vec3d{100, 100, 100} : Vec3d{x + 0.0, y + 0.0, 2});
      sheet.normals.push_back({0, 0, 1});
      sheet.residue_index.push_back(x < 3 ? 7.0F : 8.0F);
    }
  }
  for (int y = 0; y + 1 < side; ++y) {
    for (int x = 0; x + 1 < side; ++x) {
      const auto at = static_cast<std::uint32_t>(y * side + x), up = at + static_cast<std::uint32_t>(side);
      for (const Triangle& t : {Triangle{at, at + 1, up}, Triangle{at + 1, up + 1, up}}) {
        bool is_lost = false;
        for (const std::uint32_t corner : t) is_lost = is_lost || sheet.positions[corner].x == 100;
        sheet.triangles.push_back(t);
        sheet.unmatched.push_back(is_lost ? 1 : 0);
      }
    }
  }
  return sheet;
}

}  // namespace

TEST_CASE("unmatched parts move as their surroundings do, and colours end in matched triangles") {
  std::vector<Vec3f> start;
  const SurfaceFile sheet = torn_sheet(start);
  const SurfaceCover cover = cover_of(sheet, start);
  for (std::size_t v = 0; v < start.size(); ++v) {
    CHECK(norm(cover.positions[v] - (static_cast<Vec3d>(start[v]) + Vec3d{0, 0, 2})) < 1e-6);
    CHECK(cover.normals[v].z == doctest::Approx(1));
  }
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    for (const std::uint32_t corner : sheet.triangles[t]) {
      if (!sheet.is_matched(t)) CHECK(cover.matched[corner] < 0.5F);
    }
  }
  CHECK(cover.matched[0] > 0.5F);
}

TEST_CASE("the inside of a tear is no surface; its border is, and so is an unmatched part that keeps its size") {
  constexpr int kWide = 41, kMiddle = 20 * kWide + 20;
  std::vector<Vec3f> start;
  const SurfaceFile sheet = torn_sheet(start, kWide, 12);
  std::vector<Vec3f> small = start;  // on the source a third as wide
  for (Vec3f& p : small) p = {p.x / 3, p.y / 3, p.z};
  const SurfaceCover torn = cover_of(sheet, small), whole = cover_of(sheet, start);
  CHECK(torn.matched[kMiddle] < -0.5F);
  CHECK(torn.matched[kMiddle + 12] > -0.4F);
  CHECK(torn.matched[kMiddle + 15] > 0.5F);
  CHECK(whole.matched[kMiddle] > -1e-6F);
}

TEST_CASE("a surface without unmatched parts is drawn as it is") {
  std::vector<Vec3f> start;
  SurfaceFile sheet = torn_sheet(start);
  sheet.unmatched.clear();
  const SurfaceCover cover = cover_of(sheet, start);
  CHECK(cover.positions[40].x == 100);
  CHECK(cover.matched == std::vector<float>(start.size(), 1));
}

TEST_CASE("values reach over the border of an unmatched part, and none is made up elsewhere") {
  std::vector<Vec3f> start;
  const SurfaceFile sheet = torn_sheet(start);
  std::vector<float> values(start.size(), 3);
  values[40] = values[0] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> filled = filled_at_border(sheet, values);
  CHECK(filled[40] == 3);
  CHECK(std::isnan(filled[0]));
}

TEST_CASE("the outline of residues lies between them") {
  std::vector<Vec3f> start;
  const SurfaceFile sheet = torn_sheet(start);
  const std::vector<float> share = share_of_residues(sheet, {7});
  CHECK(share[36] > 0.5F);
  CHECK(share[44] < 0.5F);
  CHECK(share_of_residues(sheet, {}).empty());
}

TEST_CASE("parts that are not trusted end at a smooth line, and unmatched triangles count for neither") {
  std::vector<Vec3f> start;
  SurfaceFile sheet = torn_sheet(start);
  for (const Triangle& t : sheet.triangles) sheet.untrusted.push_back(start[t[0]].x < 4 ? 1 : 0);
  const SurfaceCover cover = cover_of(sheet, start);
  float before = 0;
  for (std::size_t x = 0; x < kSide; ++x) {  // along the edge, where nothing is lost
    CHECK(cover.trusted[x] >= before);
    before = cover.trusted[x];
  }
  CHECK(cover.trusted[1] < 0.2F);
  CHECK(cover.trusted[kSide - 2] > 0.8F);
  CHECK(cover.trusted[4 * kSide + 4] == 1);  // in the hole
  sheet.untrusted.clear();
  for (const float share : cover_of(sheet, start).trusted) CHECK(share == 1);
}
