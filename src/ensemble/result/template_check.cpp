// template_check.cpp: carries one template's answer to the other's surface.
#include "ensemble/result/template_check.h"

#include <algorithm>
#include <cmath>

#include "base/not_a_number.h"
#include "base/progress.h"
#include "ensemble/file/ensemble_file.h"
#include "ensemble/result/ensemble_result.h"

namespace espdiff {
namespace {

constexpr double kFar_A = 2;

/// [vertex of the first] the nearest vertex of the other; -1 beyond kFar_A.
std::vector<std::int64_t> nearest_vertices(const std::vector<Vec3d>& first, const std::vector<Vec3d>& other) {
  std::vector<std::int64_t> nearest(first.size(), -1);
  const CancelRequest cancel;
#pragma omp parallel for schedule(static)
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (cancel.made()) continue;
    double best = kFar_A * kFar_A;
    for (std::size_t w = 0; w < other.size(); ++w) {
      const Vec3d d = first[v] - other[w];
      const double square = dot(d, d);
      if (square >= best) continue;
      best = square;
      nearest[v] = static_cast<std::int64_t>(w);
    }
  }
  cancel.check();
  return nearest;
}

}  // namespace

TemplateCheck check_template(const EnsembleFile& first, const EnsembleResult& a, const EnsembleFile& other,
                             const EnsembleResult& b, const RigidTransform& to_first) {
  TemplateCheck check;
  check.template_name = other.plan().template_name;
  check.mean_abs_difference = b.test.mean_abs_difference;
  check.significant_area_A2 = b.significant_area_A2;
  std::vector<Vec3d> moved;
  for (const Vec3d& p : other.surface().positions) moved.push_back(to_first.apply(p));
  const std::vector<std::int64_t> nearest = nearest_vertices(first.surface().positions, moved);
  double both = 0, either = 0;
  for (std::size_t v = 0; v < nearest.size(); ++v) {
    if (a.tested[v] == 0 || nearest[v] < 0 || b.tested[static_cast<std::size_t>(nearest[v])] == 0) continue;
    const bool here = a.family_wise()[v] <= a.options.alpha;
    const bool there = b.family_wise()[static_cast<std::size_t>(nearest[v])] <= b.options.alpha;
    both += here && there ? a.graph.area[v] : 0;
    either += here || there ? a.graph.area[v] : 0;
  }
  check.overlap = either > 0 ? both / either : kNaN;
  check.largest_change = a.patches.empty() ? kNaN : 0;
  for (std::size_t k = 0; k < a.patches.size(); ++k) {
    double sum = 0, area = 0;
    for (const std::uint32_t v : a.patches[k].patch.vertices) {
      if (nearest[v] < 0 || b.tested[static_cast<std::size_t>(nearest[v])] == 0) continue;
      sum += a.graph.area[v] * b.test.vertices.difference[static_cast<std::size_t>(nearest[v])];
      area += a.graph.area[v];
    }
    check.patch_differences.push_back(area > 0 ? sum / area : kNaN);
    const double change = std::fabs(check.patch_differences.back() - a.patch_tests.difference[k]);
    if (std::isfinite(change)) check.largest_change = std::max(check.largest_change, change);
  }
  return check;
}

}  // namespace espdiff
