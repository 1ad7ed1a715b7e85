// map_warnings.cpp: samples maps at the atoms.
#include "compare/map_warnings.h"

#include <array>
#include <cmath>

#include "base/formatted.h"
#include "base/not_a_number.h"
#include "compare/input.h"

namespace espdiff {
namespace {

constexpr std::size_t kLeastAtoms = 20;
/// Chosen between what a right map reaches, near 1, and one shifted by 3 A, near 0. The range of real maps has not been
/// measured.
constexpr double kLeastCorrelation = 0.3;
/// An exchanged map fits the other molecule better by at least this.
constexpr double kBetterByExchange = 0.05;

/// Trilinear samples of a map whose axes may be skewed.
class MapSampler {
 public:
  explicit MapSampler(const Grid& map) : map_(map) {
    const auto& step = map.lattice.step;
    const double volume = dot(step[0], cross(step[1], step[2]));
    for (std::size_t axis = 0; axis < 3; ++axis)
      reciprocal_[axis] = (1 / volume) * cross(step[(axis + 1) % 3], step[(axis + 2) % 3]);
  }

  /// NaN outside.
  double operator()(const Vec3d& p) const {
    std::array<std::size_t, 3> low, high;
    std::array<double, 3> share;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double n = map_.lattice.size[axis];
      double place = dot(reciprocal_[axis], p - map_.lattice.origin);
      if (map_.periodic) place -= n * std::floor(place / n);
      if (!(place >= 0) || place > (map_.periodic ? n : n - 1)) return kNaN;
      const double whole = std::min(std::floor(place), map_.periodic ? n - 1 : std::max(n - 2, 0.0));
      share[axis] = place - whole;
      low[axis] = static_cast<std::size_t>(whole);
      high[axis] = (low[axis] + 1) % static_cast<std::size_t>(n);
    }
    double sum = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::array<std::size_t, 3> at;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool upper = ((corner >> axis) & 1U) != 0;
        at[axis] = upper ? high[axis] : low[axis];
        weight *= upper ? share[axis] : 1 - share[axis];
      }
      const auto nx = static_cast<std::size_t>(map_.lattice.size[0]),
                 ny = static_cast<std::size_t>(map_.lattice.size[1]);
      if (weight != 0) sum += weight * static_cast<double>(map_.values[at[0] + nx * (at[1] + ny * at[2])]);
    }
    return sum;
  }

 private:
  const Grid& map_;
  std::array<Vec3d, 3> reciprocal_;
};

}  // namespace

double map_correlation(const Grid& map, const Molecule& molecule) {
  const MapSampler sample(map);
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < molecule.charges.size(); ++i) {
    const double q = static_cast<double>(molecule.charges[i]), value = sample(molecule.positions[i]);
    if (!std::isfinite(value)) continue;
    ++n;
    x += q;
    y += value;
    xx += q * q;
    yy += value * value;
    xy += q * value;
  }
  const double square = (xx - x * x / n) * (yy - y * y / n);
  return n >= kLeastAtoms && square > 0 ? (xy - x * y / n) / std::sqrt(square) : kNaN;
}

std::vector<Warning> map_warnings(const CompareInput& source, const CompareInput& target, bool& checked) {
  std::vector<Warning> warnings;
  checked = true;
  if (source.map == nullptr && target.map == nullptr) return warnings;
  const double of_source = source.map != nullptr ? map_correlation(*source.map, *source.molecule) : kNaN,
               of_target = target.map != nullptr ? map_correlation(*target.map, *target.molecule) : kNaN;
  checked = (source.map == nullptr || std::isfinite(of_source)) && (target.map == nullptr || std::isfinite(of_target));
  if (source.map != nullptr && target.map != nullptr) {
    const double a = map_correlation(*source.map, *target.molecule), b = map_correlation(*target.map, *source.molecule);
    if (a > of_source + kBetterByExchange && b > of_target + kBetterByExchange) {
      warnings.push_back({"the maps are exchanged: the source's fits the target's charges (correlation " +
                              formatted("%.2f", a) + " against " + formatted("%.2f", of_source) +
                              "), the target's the source's (" + formatted("%.2f", b) + " against " +
                              formatted("%.2f", of_target) + ")",
                          true});
      return warnings;
    }
  }
  for (const auto& [role, correlation] : {std::pair("source", of_source), std::pair("target", of_target)}) {
    if (!(correlation < kLeastCorrelation)) continue;
    warnings.push_back({std::string("the map of the ") + role + " does not belong to it: its values at the atoms " +
                            "correlate with the charges by " + formatted("%.2f", correlation) + " (limit " +
                            formatted("%.2f", kLeastCorrelation) +
                            "); give the map that was computed for these coordinates",
                        true});
  }
  return warnings;
}

}  // namespace espdiff
