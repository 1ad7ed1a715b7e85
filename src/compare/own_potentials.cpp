// own_potentials.cpp: area-weighted means by residue, and their correlation with the mapped differences.
#include "compare/own_potentials.h"

#include <cmath>
#include <limits>

namespace espdiff {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Residues with less surface have no potential worth comparing.
constexpr double kLeastArea_A2 = 5;
constexpr std::size_t kLeastResidues = 5;

}  // namespace

std::vector<double> own_potentials(const Mesh& surface, const std::vector<std::int32_t>& residue,
                                   const std::vector<float>& potential, std::size_t n_residues) {
  std::vector<double> sum(n_residues, 0.0), area(n_residues, 0.0);
  for (const Triangle& t : surface.triangles) {
    const Vec3f &a = surface.positions[t[0]], &b = surface.positions[t[1]], &c = surface.positions[t[2]];
    const double third = static_cast<double>(norm(cross(b - a, c - a))) / 6;
    for (const std::uint32_t v : t) {
      if (residue[v] < 0 || !std::isfinite(potential[v])) continue;
      sum[static_cast<std::size_t>(residue[v])] += third * static_cast<double>(potential[v]);
      area[static_cast<std::size_t>(residue[v])] += third;
    }
  }
  for (std::size_t r = 0; r < n_residues; ++r) sum[r] = area[r] < kLeastArea_A2 ? kNan : sum[r] / area[r];
  return sum;
}

void set_own_differences(std::vector<ResidueRow>& rows, const std::vector<double>& source,
                         const std::vector<double>& target, const std::vector<std::int32_t>& target_of) {
  for (ResidueRow& row : rows) {
    const std::int32_t partner = target_of[row.residue];
    row.own_difference = partner < 0 ? kNan : target[static_cast<std::size_t>(partner)] - source[row.residue];
  }
}

ResidueCheck check_residues(const std::vector<ResidueRow>& rows, const std::vector<double>& source) {
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0, errors = 0, potentials = 0;
  ResidueCheck check{kNan, kNan, kNan, 0};
  for (const ResidueRow& row : rows) {
    if (!(row.area_A2 >= kLeastArea_A2) || !std::isfinite(row.own_difference)) continue;
    const double a = row.own_difference, b = row.mean_signed_difference;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
    errors += (b - a) * (b - a);
    potentials += source[row.residue] * source[row.residue];
    ++check.n_residues;
  }
  if (check.n_residues < kLeastResidues) return check;
  const double n = static_cast<double>(check.n_residues);
  check.rms_error = std::sqrt(errors / n);
  check.rms_potential = std::sqrt(potentials / n);
  const double square = (xx - x * x / n) * (yy - y * y / n);
  if (square > 0) check.correlation = (xy - x * y / n) / std::sqrt(square);
  return check;
}

}  // namespace espdiff
