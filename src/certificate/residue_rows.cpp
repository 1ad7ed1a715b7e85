// residue_rows.cpp: the comparison by residue.
#include "certificate/residue_rows.h"

#include <cmath>
#include <limits>

#include "base/not_a_number.h"
#include "base/triangle_areas.h"

namespace espdiff {
namespace {

/// Slip and matched area of each residue, and which share of its surface is trusted.
void add_slip_and_trust(const MappedSurface& s, std::vector<ResidueRow>& rows) {
  const auto is_trusted = [&](std::size_t t) { return s.why[t] == 0; };
  const auto is_valid = [&](std::size_t t) {
    return s.corrupt[t] == 0 && (s.unmatched.empty() || s.unmatched[t] == 0);
  };
  const std::vector<double> matched = corner_areas(s.positions, s.triangles, is_valid),
                            own = corner_areas(s.source_positions, s.triangles, [](std::size_t) { return true; }),
                            trusted = corner_areas(s.source_positions, s.triangles, is_trusted);
  std::vector<double> slip_area(rows.size(), 0.0), own_area(rows.size(), 0.0);
  for (std::size_t v = 0; v < matched.size(); ++v) {
    if (s.residue[v] < 0) continue;
    const auto r = static_cast<std::size_t>(s.residue[v]);
    own_area[r] += own[v];
    rows[r].trusted_area_fraction += trusted[v];
    rows[r].matched_area_A2 += matched[v];
    if (s.slip.empty() || std::isnan(s.slip[v]) || matched[v] <= 0) continue;
    const double slip = static_cast<double>(s.slip[v]);
    slip_area[r] += matched[v];
    rows[r].mean_slip_A += matched[v] * slip;
    rows[r].slip_area_fraction += slip > kLargeSlip_A ? matched[v] : 0;
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r].mean_slip_A *= slip_area[r] > 0 ? 1 / slip_area[r] : kNaN;
    rows[r].slip_area_fraction *= slip_area[r] > 0 ? 1 / slip_area[r] : kNaN;
    rows[r].trusted_area_fraction *= own_area[r] > 0 ? 1 / own_area[r] : kNaN;
  }
}

}  // namespace

std::vector<ResidueRow> residue_rows(const MappedSurface& s, std::size_t n_residues, bool has_potential) {
  const std::vector<double> weight =
      corner_areas(s.positions, s.triangles, [&](std::size_t t) { return s.why[t] == 0; });
  std::vector<ResidueRow> rows(n_residues);
  add_slip_and_trust(s, rows);
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
