// drawn_part.cpp: the borders of a drawn part, as isolines of fields at the vertices.
#include "drawn_part.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/smooth_field.h"
#include "scene/reasons.h"

namespace espdiff::vmdplugin {
namespace {

/// Uncertainty of each vertex in units of the limit; 1 on the smooth border of parts that are not trusted.
std::vector<float> relative_uncertainty(const DrawnSurface& surface, const DrawnPart& part,
                                        const std::vector<float>& corrupt_share) {
  constexpr float kMost = 4;  // finite, so that it can be interpolated
  std::vector<float> result(surface.positions.size(), 0);
  std::vector<float> uncertainty;
  if (part.limit_A > 0 && surface.uncertainty != nullptr)
    uncertainty = drawn_uncertainty(*surface.triangles, *surface.uncertainty);
  for (std::size_t v = 0; v < result.size(); ++v) {
    if (!uncertainty.empty()) {
      const float share = uncertainty[v] / static_cast<float>(part.limit_A);
      result[v] = std::isfinite(share) ? std::min(share, kMost) : kMost;
    }
    if (part.corrupt == "uncertain") result[v] = std::max(result[v], 2 * corrupt_share[v]);
  }
  return result;
}

/// [vertex] how much larger the share of a reason is than that of any other: its part begins at 0.
std::vector<float> lead_of_reason(const DrawnSurface& surface, std::size_t reason) {
  const auto shares = shares_of_reasons({*surface.triangles, *surface.why, *surface.turned}, surface.positions.size());
  std::vector<float> lead = shares.at(reason);
  for (std::size_t v = 0; v < lead.size(); ++v) {
    float other = 0;
    for (std::size_t r = 0; r < shares.size(); ++r)
      if (r != reason) other = std::max(other, shares[r][v]);
    lead[v] -= other;
  }
  return lead;
}

class PartCutter {
 public:
  PartCutter(const DrawnSurface& surface, const DrawnPart& part, std::vector<float> values)
      : surface_(surface), part_(part), drawn_{ClippedSurface(surface.positions, surface.normals), 0, {}, {}, {}, {}} {
    const std::size_t n = surface.positions.size();
    const std::vector<float> corrupt = flagged_share(*surface.triangles, surface.untrusted, n);
    drawn_.value = clipped_.add_field(std::move(values));
    uncertainty_ = clipped_.add_field(relative_uncertainty(surface, part, corrupt));
    corrupt_ = clipped_.add_field(corrupt);
    unmatched_ = clipped_.add_field(has_unmatched() ? flagged_share(*surface.triangles, *surface.unmatched, n)
                                                    : std::vector<float>(n, 0));
    if (part.reason >= 0) reason_ = clipped_.add_field(lead_of_reason(surface, static_cast<std::size_t>(part.reason)));
    std::vector<float> stripes;
    stripes.reserve(n);
    for (const Vec3f p : surface.positions) stripes.push_back((p.x + p.y + p.z) / (1.732F * kStripes_A));
    stripes_ = clipped_.add_field(std::move(stripes));
  }

  CutPart cut() {
    // Where unmatched triangles cannot be drawn, the line lies within the matched ones.
    const float border = surface_.has_unmatched_positions ? surface_.border : 0.2F;
    for (std::size_t t = 0; t < surface_.triangles->size(); ++t) {
      const Triangle& corners = (*surface_.triangles)[t];
      const Polygon triangle(corners.begin(), corners.end());
      if (!has_unmatched()) {
        cut_matched(triangle);
        continue;
      }
      const bool can_be_drawn = surface_.has_unmatched_positions || (*surface_.unmatched)[t] == 0;
      if (can_be_drawn) cut_matched(clipped_.keep_below(triangle, unmatched_, border));
      if (part_.hatches && surface_.has_unmatched_positions) hatch(clipped_.keep_above(triangle, unmatched_, border));
    }
    return std::move(drawn_);
  }

 private:
  static constexpr float kStripes_A = 1.6F;  ///< distance of stripes

  bool has_unmatched() const { return surface_.unmatched != nullptr && !surface_.unmatched->empty(); }

  void cut_matched(Polygon polygon) {
    if (part_.reason >= 0) polygon = clipped_.keep_above(polygon, reason_, 0);
    if (part_.from > 0) polygon = clipped_.keep_above(polygon, uncertainty_, part_.from);
    polygon = clipped_.keep_below(polygon, uncertainty_, part_.to);
    if (part_.corrupt == "mark")
      ClippedSurface::append_fan(clipped_.keep_above(polygon, corrupt_, 0.5F), drawn_.marked);
    if (part_.corrupt == "mark" || part_.corrupt == "hide") polygon = clipped_.keep_below(polygon, corrupt_, 0.5F);
    ClippedSurface::append_fan(polygon, drawn_.coloured);
  }

  /// Cuts a polygon into stripes.
  void hatch(Polygon polygon) {
    if (polygon.empty()) return;
    const std::vector<float>& stripe = clipped_.field(stripes_);
    float low = stripe[polygon[0]], high = low;
    for (const std::uint32_t v : polygon) {
      low = std::min(low, stripe[v]);
      high = std::max(high, stripe[v]);
    }
    for (float end = std::floor(2 * low) / 2 + 0.5F; !polygon.empty(); end += 0.5F) {
      const bool is_dark = std::fmod(std::fabs(std::floor(2 * end)), 2.0F) < 0.5F;
      ClippedSurface::append_fan(clipped_.keep_below(polygon, stripes_, end), is_dark ? drawn_.dark : drawn_.light);
      if (end > high) break;
      polygon = clipped_.keep_above(polygon, stripes_, end);
    }
  }

  const DrawnSurface& surface_;
  const DrawnPart& part_;
  CutPart drawn_;
  ClippedSurface& clipped_ = drawn_.surface;
  ClippedSurface::FieldId uncertainty_ = 0, corrupt_ = 0, unmatched_ = 0, stripes_ = 0, reason_ = 0;
};

}  // namespace

CutPart cut_part(const DrawnSurface& surface, const DrawnPart& part, std::vector<float> values) {
  return PartCutter(surface, part, std::move(values)).cut();
}

}  // namespace espdiff::vmdplugin
