// residue_rows.cpp: the comparison by residue.
#include "compare/residue_rows.h"

#include <cmath>

#include "base/not_a_number.h"

namespace espdiff {
namespace {

bool signs_differ(double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); }

/// [vertex] a third of the area of each triangle that counts.
template <typename Counts, typename Positions>
std::vector<double> thirds(const MappedSurface& s, const Positions& p, const Counts& counts) {
  std::vector<double> weight(s.positions.size(), 0.0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (!counts(t)) continue;
    const Triangle& v = s.triangles[t];
    const double area = 0.5 * norm(cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]));
    for (const std::uint32_t c : v) weight[c] += area / 3;
  }
  return weight;
}

/// Slip and matched area of each residue, and which share of its surface is trusted.
void add_slip_and_trust(const MappedSurface& s, std::vector<ResidueRow>& rows) {
  const auto is_trusted = [&](std::size_t t) { return s.why[t] == 0; };
  const auto is_valid = [&](std::size_t t) {
    return s.corrupt[t] == 0 && (s.unmatched.empty() || s.unmatched[t] == 0);
  };
  const std::vector<double> matched = thirds(s, s.positions, is_valid),
                            own = thirds(s, s.source_positions, [](std::size_t) { return true; }),
                            trusted = thirds(s, s.source_positions, is_trusted);
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
  const std::vector<double> weight = thirds(s, s.positions, [&](std::size_t t) { return s.why[t] == 0; });
  std::vector<ResidueRow> rows(n_residues);
  add_slip_and_trust(s, rows);
  for (std::size_t v = 0; v < weight.size(); ++v) {
    if (s.residue[v] < 0 || weight[v] <= 0) continue;
    ResidueRow& row = rows[static_cast<std::size_t>(s.residue[v])];
    row.area_A2 += weight[v];
    row.mean_displacement_A += weight[v] * static_cast<double>(s.displacement[v]);
    row.mean_path_length_A += weight[v] * static_cast<double>(s.path_length[v]);
    if (!has_potential) continue;
    const double a = static_cast<double>(s.potential_source[v]), b = static_cast<double>(s.potential_target[v]);
    row.mean_abs_difference += weight[v] * std::fabs(b - a);
    row.mean_signed_difference += weight[v] * (b - a);
    row.mean_source += weight[v] * a;
    row.mean_target += weight[v] * b;
    row.sign_change_area_fraction += signs_differ(a, b) ? weight[v] : 0;
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    ResidueRow& row = rows[r];
    row.residue = r;
    const double scale = row.area_A2 > 0 ? 1 / row.area_A2 : kNaN;
    row.mean_displacement_A *= scale;
    row.mean_path_length_A *= scale;
    for (double* value : {&row.mean_abs_difference, &row.mean_signed_difference, &row.mean_source, &row.mean_target,
                          &row.sign_change_area_fraction}) {
      *value *= has_potential ? scale : kNaN;
    }
  }
  return rows;
}

}  // namespace espdiff
