// clip_surface.cpp: polygons cut at a level (Sutherland and Hodgman, 1974), with shared vertices on shared edges.
#include "clip_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/smooth_field.h"

namespace espdiff {
namespace {

Vec3f mixed(Vec3f a, Vec3f b, float share) { return a + share * (b - a); }

Vec3f unit(Vec3f v) {
  const float length = std::sqrt(dot(v, v));
  return length > 0 ? (1 / length) * v : v;
}

}  // namespace

ClippedSurface::ClippedSurface(std::vector<Vec3f> positions, std::vector<Vec3f> normals)
    : positions_(std::move(positions)), normals_(std::move(normals)) {}

ClippedSurface::FieldId ClippedSurface::add_field(std::vector<float> values) {
  fields_.push_back(std::move(values));
  return fields_.size() - 1;
}

Polygon ClippedSurface::keep_below(const Polygon& polygon, FieldId field, float level) {
  return keep(polygon, field, level, true);
}

Polygon ClippedSurface::keep_above(const Polygon& polygon, FieldId field, float level) {
  return keep(polygon, field, level, false);
}

Polygon ClippedSurface::keep(const Polygon& polygon, FieldId field, float level, bool below) {
  const auto is_kept = [&](std::uint32_t v) { return (fields_[field][v] < level) == below; };
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::uint32_t a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (is_kept(a)) kept.push_back(a);
    if (is_kept(a) != is_kept(b)) kept.push_back(cut_edge(a, b, field, level));
  }
  if (kept.size() < 3) kept.clear();
  return kept;
}

std::uint32_t ClippedSurface::cut_edge(std::uint32_t a, std::uint32_t b, FieldId field, float level) {
  if (a > b) std::swap(a, b);  // the same bits from both sides of the edge
  const auto [place, is_new] = cuts_.try_emplace({a, b, field, level}, 0);
  if (!is_new) return place->second;
  const float from = fields_[field][a], to = fields_[field][b];
  const float share = (level - from) / (to - from);
  place->second = static_cast<std::uint32_t>(positions_.size());
  positions_.push_back(mixed(positions_[a], positions_[b], share));
  normals_.push_back(unit(mixed(normals_[a], normals_[b], share)));
  for (std::vector<float>& values : fields_) values.push_back(values[a] + share * (values[b] - values[a]));
  fields_[field].back() = level;
  return place->second;
}

void ClippedSurface::append_fan(const Polygon& polygon, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < polygon.size(); ++i) triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
}

std::vector<float> flagged_share(const std::vector<Triangle>& triangles, const std::vector<std::uint8_t>& flags,
                                 std::size_t n_vertices) {
  std::vector<float> share(n_vertices, 0), n_around(n_vertices, 0);
  if (flags.empty()) return share;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t]) {
      share[v] += flags[t] != 0 ? 1.0F : 0.0F;
      n_around[v] += 1;
    }
  }
  for (std::size_t v = 0; v < n_vertices; ++v) share[v] /= std::max(1.0F, n_around[v]);
  return smoothed_over_neighbours(triangles, std::move(share), 3);
}

}  // namespace espdiff
