// slip.cpp: area-weighted quantiles of the slip.
#include "certificate/slip.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>

#include "base/not_a_number.h"
#include "base/triangle_areas.h"

namespace espdiff {
namespace {

struct SlippedArea {
  float slip;
  double area;
};

/// Smallest slip first, then smallest area: by the digits of the slip, whose bits have the order of its values.
void sort_by_slip(std::vector<SlippedArea>& areas) {
  constexpr unsigned kDigit = 11, kDigits = 3;
  std::vector<SlippedArea> sorted(areas.size());
  for (unsigned digit = 0; digit < kDigits; ++digit) {
    const auto place = [&](const SlippedArea& a) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &a.slip, sizeof bits);
      return bits >> digit * kDigit & ((1U << kDigit) - 1);
    };
    std::vector<std::size_t> first((1U << kDigit) + 1, 0);
    for (const SlippedArea& a : areas) ++first[place(a) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    for (const SlippedArea& a : areas) sorted[first[place(a)]++] = a;
    areas.swap(sorted);
  }
  for (auto begin = areas.begin(); begin != areas.end();) {
    const auto end = std::find_if(begin, areas.end(), [&](const SlippedArea& a) { return a.slip != begin->slip; });
    std::sort(begin, end, [](const SlippedArea& a, const SlippedArea& b) { return a.area < b.area; });
    begin = end;
  }
}

}  // namespace

SurfaceAreas surface_areas(const MappedSurface& s) {
  SurfaceAreas areas;
  areas.mapped.resize(s.triangles.size());
  if (!s.source_positions.empty()) areas.source.resize(s.triangles.size());
  const auto n = static_cast<std::ptrdiff_t>(s.triangles.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t triangle = 0; triangle < n; ++triangle) {
    const auto t = static_cast<std::size_t>(triangle);
    areas.mapped[t] = triangle_area(s.positions, s.triangles[t]);
    if (!areas.source.empty()) areas.source[t] = triangle_area(s.source_positions, s.triangles[t]);
  }
  return areas;
}

std::vector<double> matched_areas(const MappedSurface& s, const SurfaceAreas& areas) {
  std::vector<double> of_vertex(s.positions.size(), 0.0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.corrupt[t] != 0 || (!s.unmatched.empty() && s.unmatched[t] != 0)) continue;
    const double third = areas.mapped[t] / 3;
    for (const std::uint32_t c : s.triangles[t]) of_vertex[c] += third;
  }
  return of_vertex;
}

double share_outside(const MappedSurface& surface, const std::vector<double>& areas) {
  double all = 0, outside = 0;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    all += areas[v];
    if (std::isnan(surface.potential_source[v]) || std::isnan(surface.potential_target[v])) outside += areas[v];
  }
  return all > 0 ? outside / all : 0;
}

SlipSummary summarize_slip(const MappedSurface& surface, const std::vector<double>& areas) {
  std::vector<SlippedArea> by_slip;
  double all = 0, known = 0, sum = 0;
  SlipSummary summary;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    all += areas[v];
    const double slip = static_cast<double>(surface.slip[v]);
    if (areas[v] <= 0 || std::isnan(slip)) continue;
    known += areas[v];
    sum += areas[v] * slip;
    if (slip > kMediumSlip_A) summary.medium_area_fraction += areas[v];
    if (slip > kLargeSlip_A) summary.large_area_fraction += areas[v];
    by_slip.push_back({surface.slip[v], areas[v]});
  }
  if (by_slip.empty()) return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, 1};
  summary.mean_A = sum / known;
  summary.medium_area_fraction /= known;
  summary.large_area_fraction /= known;
  summary.unpaired_area_fraction = 1 - known / all;
  sort_by_slip(by_slip);
  const auto quantile = [&](double share) {
    double below = 0;
    for (const auto& [slip, area] : by_slip) {
      below += area;
      if (below >= share * known) return static_cast<double>(slip);
    }
    return static_cast<double>(by_slip.back().slip);
  };
  summary.median_A = quantile(0.5);
  summary.p95_A = quantile(0.95);
  summary.max_A = static_cast<double>(by_slip.back().slip);
  return summary;
}

}  // namespace espdiff
