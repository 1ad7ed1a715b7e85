// residue_rows.cpp: the comparison by residue.
#include "compare/residue_rows.h"

#include <cmath>

#include "base/not_a_number.h"

namespace espdiff {
namespace {

bool signs_differ(double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); }

}  // namespace

/// Averages over the valid area of each residue, weighted like the metrics: a third of each valid triangle at each
/// vertex.
std::vector<ResidueRow> residue_rows(const MappedSurface& s, std::size_t n_residues, bool has_potential) {
  std::vector<double> weight(s.positions.size(), 0.0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const Triangle& v = s.triangles[t];
    bool counts = s.corrupt[t] == 0 && (s.unmatched.empty() || s.unmatched[t] == 0);
    for (const std::uint32_t c : v) {
      counts =
          counts && (!has_potential || (std::isfinite(s.potential_source[c]) && std::isfinite(s.potential_target[c])));
    }
    if (!counts) continue;
    const double area = 0.5 * norm(cross(s.positions[v[1]] - s.positions[v[0]], s.positions[v[2]] - s.positions[v[0]]));
    for (const std::uint32_t c : v) weight[c] += area / 3;
  }
  std::vector<ResidueRow> rows(n_residues);
  std::vector<double> slip_area(n_residues, 0.0);
  for (std::size_t v = 0; v < weight.size(); ++v) {
    if (s.residue[v] < 0 || weight[v] <= 0) continue;
    ResidueRow& row = rows[static_cast<std::size_t>(s.residue[v])];
    row.area_A2 += weight[v];
    row.mean_displacement_A += weight[v] * static_cast<double>(s.displacement[v]);
    row.mean_path_length_A += weight[v] * static_cast<double>(s.path_length[v]);
    if (!s.slip.empty() && !std::isnan(s.slip[v])) {
      const double slip = static_cast<double>(s.slip[v]);
      slip_area[static_cast<std::size_t>(s.residue[v])] += weight[v];
      row.mean_slip_A += weight[v] * slip;
      row.slip_area_fraction += slip > kLargeSlip_A ? weight[v] : 0;
    }
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
    row.mean_slip_A *= slip_area[r] > 0 ? 1 / slip_area[r] : kNaN;
    row.slip_area_fraction *= slip_area[r] > 0 ? 1 / slip_area[r] : kNaN;
    for (double* value : {&row.mean_abs_difference, &row.mean_signed_difference, &row.mean_source, &row.mean_target,
                          &row.sign_change_area_fraction}) {
      *value *= has_potential ? scale : kNaN;
    }
  }
  return rows;
}

}  // namespace espdiff
