// reasons.cpp: which reason a triangle is drawn as, its share of the surface, and its smooth borders.
#include "scene/reasons.h"

#include <doctest/doctest.h>

#include <string>

#include "scene/surface_file.h"
#include "support/test_data.h"

using espdiff::Triangle;
using espdiff::Vec3d;

TEST_CASE("each code of OUT.vtp is drawn as its reason, and a trusted side chain that turned as one of its own") {
  std::vector<Triangle> triangles;
  std::vector<Vec3d> positions;
  for (std::uint32_t t = 0; t < 10; ++t) {
    triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}) positions.push_back(p);
  }
  const std::vector<std::uint8_t> why = {0, 1, 2, 3, 4, 5, 6, 7, 8, 0};
  std::vector<std::uint8_t> turned(30, 0);
  turned[0] = 1;                                          // one corner of three does not count
  turned[27] = turned[28] = turned[12] = turned[13] = 1;  // of a trusted one, and of one that slipped
  std::string keys;
  for (const std::size_t reason : espdiff::drawn_reasons({triangles, why, turned}))
    keys += reason < espdiff::kNumberOfDrawnReasons ? std::string(espdiff::kDrawnReasons[reason].key) + " " : "- ";
  CHECK(keys == "trusted - corrupt unpaired slipped other_residue disagrees no_potential turned turned_side_chain ");
  const auto areas = espdiff::areas_of_reasons({triangles, why, turned}, positions);
  for (const double area : areas) CHECK(area == doctest::Approx(0.1));  // and a tenth is unmatched
  CHECK(espdiff::drawn_reasons({triangles, why, {}})[9] == 0);
}

TEST_CASE("the shares of reasons add up to one, and change smoothly across a border") {
  constexpr std::uint32_t kSide = 12;
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> why;
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t at = y * kSide + x, up = at + kSide;
      for (const Triangle& t : {Triangle{at, at + 1, up}, Triangle{at + 1, up + 1, up}}) {
        triangles.push_back(t);
        why.push_back(x < kSide / 2 ? 0 : 4);
      }
    }
  }
  const auto shares = espdiff::shares_of_reasons({triangles, why, {}}, kSide * kSide);
  const std::size_t row = 5 * kSide;
  for (std::size_t x = 0; x < kSide; ++x) {
    CHECK(shares[0][row + x] + shares[1][row + x] == doctest::Approx(1));
    if (x > 0) CHECK(shares[1][row + x] >= shares[1][row + x - 1]);
  }
  CHECK(shares[1][row] < 0.1F);
  CHECK(shares[1][row + kSide - 1] > 0.9F);
  CHECK(shares[1][row + kSide / 2] == doctest::Approx(0.5).epsilon(0.2));
}

TEST_CASE("a file without reasons cannot be drawn by them") {
  espdiff::SurfaceFile file;
  file.path = "old.vtp";
  CHECK(espdiff_test::message_of([&] { file.values(espdiff::RenderArray::kWhy); }) ==
        "old.vtp: has no cell array 'why', so that it cannot be drawn by reason; compare the pair again");
}
