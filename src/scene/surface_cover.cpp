// surface_cover.cpp: harmonic displacements over unmatched parts, and smooth shares for borders.
#include "scene/surface_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "base/smooth_field.h"
#include "base/triangle_areas.h"

namespace espdiff {
namespace {

constexpr int kSpreadRounds = 400;  // over parts of some 20 triangles across
constexpr int kBorderRounds = 4, kOutlineRounds = 12, kTearRounds = 12;

/// Gauss-Seidel: each free vertex becomes the mean of its neighbours.
void spread(const std::vector<Triangle>& triangles, const std::vector<bool>& is_free, std::vector<Vec3d>& values) {
  std::vector<std::vector<std::uint32_t>> neighbours(values.size());
  std::vector<std::uint32_t> free;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (is_free[t[k]]) neighbours[t[k]].insert(neighbours[t[k]].end(), {t[(k + 1) % 3], t[(k + 2) % 3]});
    }
  }
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (is_free[v] && !neighbours[v].empty()) free.push_back(static_cast<std::uint32_t>(v));
  }
  for (int round = 0; round < kSpreadRounds; ++round) {
    for (const std::uint32_t v : free) {
      Vec3d sum{};
      for (const std::uint32_t n : neighbours[v]) sum += values[n];
      values[v] = (1.0 / static_cast<double>(neighbours[v].size())) * sum;
    }
  }
}

/// Replaces the normals of some vertices by the area-weighted means of their triangles'.
void renew_normals(const std::vector<Triangle>& triangles, const std::vector<bool>& is_new, SurfaceCover& cover) {
  std::vector<Vec3d> sums(cover.positions.size());
  const auto& p = cover.positions;
  for (const Triangle& t : triangles) {
    if (!is_new[t[0]] && !is_new[t[1]] && !is_new[t[2]]) continue;
    const Vec3d area = cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
    for (const std::uint32_t corner : t) sums[corner] += area;
  }
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const double length = norm(sums[v]);
    if (is_new[v] && length > 0) cover.normals[v] = static_cast<Vec3f>((1 / length) * sums[v]);
  }
}

/// [vertex] 1 inside tears, 0 outside, smooth between: most triangles around an unmatched vertex span a tear.
std::vector<float> torn_share(const SurfaceFile& surface, const std::vector<Vec3f>& start,
                              const std::vector<bool>& is_free, const SurfaceCover& cover) {
  constexpr double kTornGrowth = 3;  // of a triangle's area
  std::vector<int> n_torn(is_free.size(), 0), n_whole(is_free.size(), 0);
  for (const Triangle& t : surface.triangles) {
    if (!is_free[t[0]] && !is_free[t[1]] && !is_free[t[2]]) continue;
    const auto at = [&](std::size_t k) { return static_cast<Vec3d>(start[t[k]]); };
    const double before = triangle_area(std::array<Vec3d, 3>{at(0), at(1), at(2)}, Triangle{0, 1, 2});
    const bool is_torn = triangle_area(cover.positions, t) > kTornGrowth * before;
    for (const std::uint32_t corner : t) ++(is_torn ? n_torn : n_whole)[corner];
  }
  std::vector<float> share(is_free.size(), 0);
  for (std::size_t v = 0; v < share.size(); ++v) share[v] = is_free[v] && n_torn[v] > n_whole[v] ? 1.0F : 0.0F;
  return smoothed_over_neighbours(surface.triangles, std::move(share), kTearRounds);
}

/// [vertex] share of the matched triangles around it that are trusted, smoothed.
std::vector<float> trusted_share(const SurfaceFile& surface) {
  std::vector<float> trusted(surface.positions.size(), 0), matched(surface.positions.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!surface.is_matched(t)) continue;
    for (const std::uint32_t corner : surface.triangles[t]) {
      matched[corner] += 1;
      trusted[corner] += surface.is_untrusted(t) ? 0.0F : 1.0F;
    }
  }
  for (std::size_t v = 0; v < trusted.size(); ++v)
    trusted[v] = matched[v] > 0 ? trusted[v] / matched[v] : std::numeric_limits<float>::quiet_NaN();
  trusted = smoothed_over_neighbours(surface.triangles, std::move(trusted), kBorderRounds);
  for (float& share : trusted) share = std::isnan(share) ? 1 : share;
  return trusted;
}

}  // namespace

std::vector<bool> unmatched_vertices(const SurfaceFile& surface) {
  std::vector<bool> is_unmatched(surface.positions.size(), false);
  if (surface.unmatched.empty()) return is_unmatched;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.is_matched(t)) continue;
    for (const std::uint32_t corner : surface.triangles[t]) is_unmatched[corner] = true;
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!surface.is_matched(t)) continue;
    for (const std::uint32_t corner : surface.triangles[t]) is_unmatched[corner] = false;
  }
  return is_unmatched;
}

SurfaceCover cover_of(const SurfaceFile& surface, const std::vector<Vec3f>& start) {
  SurfaceCover cover{surface.positions, surface.normals, std::vector<float>(surface.positions.size(), 1),
                     trusted_share(surface)};
  const std::vector<bool> is_free = unmatched_vertices(surface);
  if (surface.unmatched.empty()) return cover;
  std::vector<Vec3d> displacements(surface.positions.size());
  for (std::size_t v = 0; v < displacements.size(); ++v) {
    if (!is_free[v]) displacements[v] = surface.positions[v] - static_cast<Vec3d>(start[v]);
  }
  // All corners of unmatched triangles, so that the border lies in matched ones, and no colour beyond it.
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.is_matched(t)) continue;
    for (const std::uint32_t corner : surface.triangles[t]) cover.matched[corner] = 0;
  }
  spread(surface.triangles, is_free, displacements);
  for (std::size_t v = 0; v < displacements.size(); ++v) {
    if (is_free[v]) cover.positions[v] = static_cast<Vec3d>(start[v]) + displacements[v];
  }
  renew_normals(surface.triangles, is_free, cover);
  cover.matched = smoothed_over_neighbours(surface.triangles, std::move(cover.matched), kBorderRounds);
  const std::vector<float> torn = torn_share(surface, start, is_free, cover);
  for (std::size_t v = 0; v < torn.size(); ++v)
    if (is_free[v]) cover.matched[v] -= torn[v];
  return cover;
}

std::vector<float> filled_at_border(const SurfaceFile& surface, std::vector<float> values) {
  if (values.empty()) return values;
  const std::vector<bool> is_free = unmatched_vertices(surface);
  constexpr int kRings = 3;
  for (int ring = 0; ring < kRings; ++ring) {
    std::vector<float> sum(values.size(), 0), n(values.size(), 0);
    for (const Triangle& t : surface.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (!is_free[t[k]] || std::isfinite(values[t[k]])) continue;
        for (const std::uint32_t other : {t[(k + 1) % 3], t[(k + 2) % 3]}) {
          if (!std::isfinite(values[other])) continue;
          sum[t[k]] += values[other];
          n[t[k]] += 1;
        }
      }
    }
    for (std::size_t v = 0; v < values.size(); ++v)
      if (n[v] > 0) values[v] = sum[v] / n[v];
  }
  return values;
}

std::vector<float> share_of_residues(const SurfaceFile& surface, const std::vector<int>& residues) {
  if (residues.empty() || surface.residue_index.empty()) return {};
  const std::set<int> chosen(residues.begin(), residues.end());
  std::vector<float> share;
  share.reserve(surface.residue_index.size());
  for (const float residue : surface.residue_index)
    share.push_back(chosen.count(static_cast<int>(residue)) > 0 ? 1.0F : 0.0F);
  return smoothed_over_neighbours(surface.triangles, std::move(share), kOutlineRounds);
}

}  // namespace espdiff
