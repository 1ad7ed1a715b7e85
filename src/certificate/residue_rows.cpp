// residue_rows.cpp: the comparison by residue.
#include "certificate/residue_rows.h"

#include <cmath>
#include <limits>

#include "base/not_a_number.h"

namespace espdiff {
namespace {

/// Thirds of the areas of the triangles at a vertex.
struct CornerAreas {
  double own = 0;             ///< on the source, of all triangles
  double trusted_on_own = 0;  ///< on the source, of the trusted ones
  double matched = 0;         ///< mapped, of matched triangles that are not corrupt
  double trusted = 0;         ///< mapped, of the trusted ones
};

/// [vertex] all of them by one walk over the triangles
std::vector<CornerAreas> corner_areas(const MappedSurface& s, const SurfaceAreas& of_triangles) {
  std::vector<CornerAreas> areas(s.positions.size());
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const Triangle& corners = s.triangles[t];
    const bool is_trusted = s.why[t] == 0, is_valid = s.corrupt[t] == 0 && (s.unmatched.empty() || s.unmatched[t] == 0);
    const double before = of_triangles.source[t] / 3, after = is_trusted || is_valid ? of_triangles.mapped[t] / 3 : 0;
    for (const std::uint32_t c : corners) {
      CornerAreas& at = areas[c];
      at.own += before;
      if (is_trusted) at.trusted_on_own += before;
      if (is_trusted) at.trusted += after;
      if (is_valid) at.matched += after;
    }
  }
  return areas;
}

/// Slip and matched area of each residue, and which share of its surface is trusted.
void add_slip_and_trust(const MappedSurface& s, const std::vector<CornerAreas>& areas, std::vector<ResidueRow>& rows) {
  std::vector<double> slip_area(rows.size(), 0.0), own_area(rows.size(), 0.0);
  for (std::size_t v = 0; v < areas.size(); ++v) {
    if (s.residue[v] < 0) continue;
    const auto r = static_cast<std::size_t>(s.residue[v]);
    const double matched = areas[v].matched;
    own_area[r] += areas[v].own;
    rows[r].trusted_area_fraction += areas[v].trusted_on_own;
    rows[r].matched_area_A2 += matched;
    if (s.slip.empty() || std::isnan(s.slip[v]) || matched <= 0) continue;
    const double slip = static_cast<double>(s.slip[v]);
    slip_area[r] += matched;
    rows[r].mean_slip_A += matched * slip;
    rows[r].slip_area_fraction += slip > kLargeSlip_A ? matched : 0;
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r].mean_slip_A *= slip_area[r] > 0 ? 1 / slip_area[r] : kNaN;
    rows[r].slip_area_fraction *= slip_area[r] > 0 ? 1 / slip_area[r] : kNaN;
    rows[r].trusted_area_fraction *= own_area[r] > 0 ? 1 / own_area[r] : kNaN;
  }
}

}  // namespace

std::vector<ResidueRow> residue_rows(const MappedSurface& s, const SurfaceAreas& of_triangles, std::size_t n_residues,
                                     bool has_potential) {
  const std::vector<CornerAreas> areas = corner_areas(s, of_triangles);
  std::vector<double> weight(areas.size());
  for (std::size_t v = 0; v < areas.size(); ++v) weight[v] = areas[v].trusted;
  std::vector<ResidueRow> rows(n_residues);
  add_slip_and_trust(s, areas, rows);
  const std::vector<float> unknown(has_potential ? 0 : weight.size(), std::numeric_limits<float>::quiet_NaN());
  const std::vector<ResidueMeans> means = residue_means(weight, s.residue, has_potential ? s.potential_source : unknown,
                                                        has_potential ? s.potential_target : unknown, n_residues);
  for (std::size_t v = 0; v < weight.size(); ++v) {
    if (s.residue[v] < 0 || weight[v] <= 0) continue;
    ResidueRow& row = rows[static_cast<std::size_t>(s.residue[v])];
    row.mean_displacement_A += weight[v] * static_cast<double>(s.displacement[v]);
    row.mean_path_length_A += weight[v] * static_cast<double>(s.path_length[v]);
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    ResidueRow& row = rows[r];
    static_cast<ResidueMeans&>(row) = means[r];
    row.residue = r;
    if (!has_potential) row.sign_change_area_fraction = kNaN;
    const double scale = row.area_A2 > 0 ? 1 / row.area_A2 : kNaN;
    row.mean_displacement_A *= scale;
    row.mean_path_length_A *= scale;
  }
  return rows;
}

}  // namespace espdiff
