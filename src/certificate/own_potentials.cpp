// own_potentials.cpp: area-weighted means by residue, and their correlation with the mapped differences.
#include "certificate/own_potentials.h"

#include <algorithm>
#include <cmath>

#include "base/not_a_number.h"
#include "base/triangle_areas.h"

namespace espdiff {
namespace {

/// Residues with less surface have no potential worth comparing.
constexpr double kLeastOwnArea_A2 = 5;

/// [residue] whether a residue without a partner touches it.
std::vector<bool> border_residues(const Mesh& surface, const std::vector<std::int32_t>& residue,
                                  const std::vector<std::int32_t>& partner_of) {
  std::vector<bool> borders(partner_of.size(), false);
  if (std::none_of(partner_of.begin(), partner_of.end(), [](std::int32_t partner) { return partner < 0; }))
    return borders;
  const auto lacks_partner = [&](std::uint32_t v) {
    return residue[v] >= 0 && partner_of[static_cast<std::size_t>(residue[v])] < 0;
  };
  for (const Triangle& t : surface.triangles) {
    if (!std::any_of(t.begin(), t.end(), lacks_partner)) continue;
    for (const std::uint32_t v : t) {
      if (residue[v] >= 0) borders[static_cast<std::size_t>(residue[v])] = true;
    }
  }
  return borders;
}

/// [triangle] a third of its area, A^2
std::vector<double> thirds_of_areas(const Mesh& surface) {
  std::vector<double> thirds(surface.triangles.size());
  const auto n = static_cast<std::ptrdiff_t>(thirds.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < n; ++i)
    thirds[static_cast<std::size_t>(i)] =
        triangle_area(surface.positions, surface.triangles[static_cast<std::size_t>(i)]) / 3;
  return thirds;
}

bool has_both_differences(const ResidueRow& row) {
  return row.area_A2 >= kLeastOwnArea_A2 && std::isfinite(row.own_difference);
}

/// Whether the mapped mean is one of the residue: that of a strip of it, where the rest slipped or turned, says nothing
/// about the whole, which the mean on its own surfaces is of.
bool can_correlate(const ResidueRow& row) {
  constexpr double kLeastTrustedShare = 0.25;
  return has_both_differences(row) && row.trusted_area_fraction >= kLeastTrustedShare;
}

double error_of(const ResidueRow& row) { return std::fabs(row.mean_signed_difference - row.own_difference); }

/// The error that half of the weight does not exceed.
double median_error(const std::vector<ResidueRow>& rows) {
  std::vector<std::pair<double, double>> errors;
  double all = 0, below = 0;
  for (const ResidueRow& row : rows) {
    if (!has_both_differences(row)) continue;
    errors.emplace_back(error_of(row), row.own_area_A2);
    all += row.own_area_A2;
  }
  std::sort(errors.begin(), errors.end());
  for (const auto& [error, weight] : errors) {
    if ((below += weight) >= all / 2) return error;
  }
  return kNaN;
}

/// Root mean square of the potentials, weighted by area.
double rms_potential(const std::vector<OwnPotential>& own) {
  double area = 0, squares = 0;
  for (const OwnPotential& at : own) {
    if (!std::isfinite(at.mean)) continue;
    area += at.area_A2;
    squares += at.area_A2 * at.mean * at.mean;
  }
  return area > 0 ? std::sqrt(squares / area) : kNaN;
}

}  // namespace

std::vector<OwnPotential> own_potentials(const Mesh& surface, const std::vector<std::int32_t>& residue,
                                         const std::vector<float>& potential,
                                         const std::vector<std::int32_t>& partner_of) {
  std::vector<OwnPotential> own(partner_of.size());
  const std::vector<double> thirds = thirds_of_areas(surface);
  for (std::size_t t = 0; t < thirds.size(); ++t) {
    const double third = thirds[t];
    for (const std::uint32_t v : surface.triangles[t]) {
      if (residue[v] < 0 || !std::isfinite(potential[v])) continue;
      OwnPotential& at = own[static_cast<std::size_t>(residue[v])];
      at.mean += third * static_cast<double>(potential[v]);
      at.area_A2 += third;
    }
  }
  const std::vector<bool> borders = border_residues(surface, residue, partner_of);
  for (std::size_t r = 0; r < own.size(); ++r)
    own[r].mean = borders[r] || own[r].area_A2 < kLeastOwnArea_A2 ? kNaN : own[r].mean / own[r].area_A2;
  return own;
}

void set_own_differences(std::vector<ResidueRow>& rows, const std::vector<OwnPotential>& source,
                         const std::vector<OwnPotential>& target, const std::vector<std::int32_t>& target_of) {
  for (ResidueRow& row : rows) {
    row.own_difference = row.own_area_A2 = kNaN;
    const std::int32_t partner = target_of[row.residue];
    if (partner < 0) continue;
    const OwnPotential &a = source[row.residue], &b = target[static_cast<std::size_t>(partner)];
    row.own_difference = b.mean - a.mean;
    if (std::isfinite(row.own_difference)) row.own_area_A2 = 2 / (1 / a.area_A2 + 1 / b.area_A2);
  }
}

double rms_own_difference(const std::vector<ResidueRow>& rows) {
  double area = 0, squares = 0;
  for (const ResidueRow& row : rows) {
    if (!std::isfinite(row.own_difference)) continue;
    area += row.own_area_A2;
    squares += row.own_area_A2 * row.own_difference * row.own_difference;
  }
  return area > 0 ? std::sqrt(squares / area) : kNaN;
}

std::vector<std::uint8_t> disagreeing_residues(const std::vector<ResidueRow>& rows,
                                               const std::vector<OwnPotential>& source) {
  // The median of a normal distribution's absolute values is 0.6745 of its deviation.
  constexpr double kDeviationByMedian = 1.4826, kDeviations = 5, kLeastShare = 0.25;
  const double limit =
      std::max(kDeviations * kDeviationByMedian * median_error(rows), kLeastShare * rms_potential(source));
  std::vector<std::uint8_t> disagrees(rows.size(), 0);
  for (const ResidueRow& row : rows) disagrees[row.residue] = has_both_differences(row) && error_of(row) > limit;
  return disagrees;
}

ResidueCheck check_residues(const std::vector<ResidueRow>& rows, const std::vector<OwnPotential>& source) {
  double area = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0, errors = 0, potentials = 0;
  ResidueCheck check{kNaN, kNaN, kNaN, 0, 0};
  for (const ResidueRow& row : rows) {
    if (!can_correlate(row)) continue;
    const double w = row.own_area_A2, a = row.own_difference, b = row.mean_signed_difference;
    area += w;
    x += w * a;
    y += w * b;
    xx += w * a * a;
    yy += w * b * b;
    xy += w * a * b;
    errors += w * (b - a) * (b - a);
    potentials += w * source[row.residue].mean * source[row.residue].mean;
    ++check.n_residues;
  }
  if (check.n_residues < kLeastComparedResidues) return check;
  check.rms_error = std::sqrt(errors / area);
  check.rms_potential = std::sqrt(potentials / area);
  const double square = (xx - x * x / area) * (yy - y * y / area);
  if (square > 0) check.correlation = (xy - x * y / area) / std::sqrt(square);
  return check;
}

std::vector<const ResidueRow*> most_disagreeing(const std::vector<ResidueRow>& rows) {
  std::vector<const ResidueRow*> sorted;
  for (const ResidueRow& row : rows) {
    if (can_correlate(row)) sorted.push_back(&row);
  }
  const auto weighted_error = [](const ResidueRow* row) {
    const double error = row->mean_signed_difference - row->own_difference;
    return row->own_area_A2 * error * error;
  };
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const ResidueRow* a, const ResidueRow* b) { return weighted_error(a) > weighted_error(b); });
  return sorted;
}

}  // namespace espdiff
