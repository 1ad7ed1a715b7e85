// slip.cpp: area-weighted quantiles of the slip.
#include "certificate/slip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/not_a_number.h"
#include "base/triangle_areas.h"

namespace espdiff {

std::vector<double> matched_areas(const MappedSurface& s) {
  return corner_areas(s.positions, s.triangles,
                      [&](std::size_t t) { return s.corrupt[t] == 0 && (s.unmatched.empty() || s.unmatched[t] == 0); });
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
  std::vector<std::pair<double, double>> by_slip;
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
    by_slip.emplace_back(slip, areas[v]);
  }
  if (by_slip.empty()) return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, 1};
  summary.mean_A = sum / known;
  summary.medium_area_fraction /= known;
  summary.large_area_fraction /= known;
  summary.unpaired_area_fraction = 1 - known / all;
  std::sort(by_slip.begin(), by_slip.end());
  const auto quantile = [&](double share) {
    double below = 0;
    for (const auto& [slip, area] : by_slip) {
      below += area;
      if (below >= share * known) return slip;
    }
    return by_slip.back().first;
  };
  summary.median_A = quantile(0.5);
  summary.p95_A = quantile(0.95);
  summary.max_A = by_slip.back().first;
  return summary;
}

}  // namespace espdiff
