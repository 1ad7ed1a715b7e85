// slip.cpp: quantiles of the slip by area, with equal slips and unmatched triangles.
#include "certificate/slip.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "support/random.h"

using espdiff::MappedSurface;
using espdiff::SlipSummary;
using espdiff_test::Random;

namespace {

/// Separate triangles of different sizes, with slips of which many are equal, and some unknown.
MappedSurface triangles_that_slip(std::size_t n) {
  Random random(3);
  MappedSurface s;
  for (std::size_t t = 0; t < n; ++t) {
    const double size = 1 + static_cast<double>(t * 7 % 11);
    for (const espdiff::Vec3d& p : {espdiff::Vec3d{0, 0, 0}, espdiff::Vec3d{size, 0, 0}, espdiff::Vec3d{0, 2, 0}})
      s.positions.push_back(p);
    const auto v = static_cast<std::uint32_t>(3 * t);
    s.triangles.push_back({v, v + 1, v + 2});
    for (int corner = 0; corner < 3; ++corner)
      s.slip.push_back(t % 4 == 0 ? 0.0F : std::fabs(static_cast<float>(random.in_box(5).x)));
  }
  s.slip[5] = std::numeric_limits<float>::quiet_NaN();
  s.corrupt.assign(n, 0);
  s.unmatched.assign(n, 0);
  s.unmatched[1] = 1;
  s.corrupt[2] = 1;
  return s;
}

/// The slip that a share of the area does not exceed, by sorting pairs.
double quantile(const MappedSurface& s, const std::vector<double>& areas, double share) {
  std::vector<std::pair<double, double>> pairs;
  double known = 0, below = 0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    if (areas[v] <= 0 || std::isnan(s.slip[v])) continue;
    pairs.emplace_back(static_cast<double>(s.slip[v]), areas[v]);
    known += areas[v];
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [slip, area] : pairs) {
    if ((below += area) >= share * known) return slip;
  }
  return pairs.back().first;
}

}  // namespace

TEST_SUITE_BEGIN("slip");

TEST_CASE("areas are those of the triangles, before the mapping too where it is known") {
  MappedSurface s = triangles_that_slip(20);
  CHECK(surface_areas(s).source.empty());
  s.source_positions = s.positions;
  for (espdiff::Vec3d& p : s.source_positions) p = 2.0 * p;
  const espdiff::SurfaceAreas areas = surface_areas(s);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    CHECK(areas.mapped[t] == doctest::Approx(1 + static_cast<double>(t * 7 % 11)));
    CHECK(areas.source[t] == doctest::Approx(4 * areas.mapped[t]));
  }
  const std::vector<double> matched = matched_areas(s, areas);
  CHECK(matched[0] == doctest::Approx(areas.mapped[0] / 3));
  for (std::size_t v = 3; v < 9; ++v) CHECK(matched[v] == 0);  // unmatched, corrupt
}

TEST_CASE("quantiles of the slip are those of sorted pairs") {
  const MappedSurface s = triangles_that_slip(5000);
  const std::vector<double> areas = matched_areas(s, surface_areas(s));
  const SlipSummary summary = summarize_slip(s, areas);
  CHECK(summary.median_A == quantile(s, areas, 0.5));
  CHECK(summary.p95_A == quantile(s, areas, 0.95));
  CHECK(summary.max_A == quantile(s, areas, 2));
  CHECK(summary.median_A > 0);
  CHECK(summary.p95_A > summary.median_A);
}

TEST_SUITE_END();
