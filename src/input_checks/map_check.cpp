// map_check.cpp: reference potentials of a molecule's charges, and the regression of a given map on them.
#include "input_checks/map_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "align/geometry/superpose.h"
#include "base/error.h"
#include "base/multiversion.h"
#include "base/not_a_number.h"
#include "base/units.h"
#include "engine/engine.h"
#include "engine/poisson_boltzmann.h"
#include "engine/potential_stage.h"
#include "mapping/build_surface.h"

namespace espdiff {
namespace {

constexpr std::size_t kLeastCharges = 20;
constexpr double kCheckDistance_A = 2, kCoarse_A = 1.5, kCoarsePadding_A = 6, kCoarseTolerance = 1e-2;
constexpr double kBeta = 0.25;  ///< 1/A; PmeOptions' default and PMEPot's
/// The smeared charges of kBeta are smooth on this lattice.
constexpr double kSmoothSpacing_A = 2;
/// A map that is this much like one in water needs no comparison with periodic ones in vacuum.
constexpr double kSure = 0.98;

/// Weights are equal; points where either is NaN are left out.
ReferenceFit fit(const std::vector<double>& map, const std::vector<double>& reference) {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < std::min(map.size(), reference.size()); ++i) {
    if (!std::isfinite(map[i]) || !std::isfinite(reference[i])) continue;
    ++n;
    x += reference[i];
    y += map[i];
    xx += reference[i] * reference[i];
    yy += map[i] * map[i];
    xy += reference[i] * map[i];
  }
  const double sxx = xx - x * x / n, syy = yy - y * y / n, sxy = xy - x * y / n;
  if (n == 0 || !(sxx > 0)) return {kNaN, kNaN};
  return {sxy / sxx, syy > 0 ? sxy / std::sqrt(sxx * syy) : 0.0};
}

bool is_better(const ReferenceFit& a, const ReferenceFit& b) {
  return std::isfinite(a.correlation) &&
         !(std::isfinite(b.correlation) && std::fabs(b.correlation) >= std::fabs(a.correlation));
}

std::vector<Vec3d> at_points(const std::vector<Vec3d>& positions, const RigidTransform& transform) {
  std::vector<Vec3d> moved;
  for (const Vec3d& p : positions) moved.push_back(transform.apply(p));
  return moved;
}

struct PointCharge {
  Vec3d at;
  double scaled;  ///< kT A / e^2
};

/// A few points at a time, so that their distances are computed in lanes.
constexpr std::size_t kLanes = 8;

struct BlockSums {
  double vacuum[kLanes] = {}, screened[kLanes] = {}, direct[kLanes] = {};
};

ESPDIFF_MULTIVERSION void sum_charges(const std::vector<PointCharge>& charges, const Vec3d* points, std::size_t n,
                                      BlockSums& sums) {
  double x[kLanes], y[kLanes], z[kLanes], r[kLanes];
  for (std::size_t k = 0; k < kLanes; ++k) {
    const Vec3d& p = points[std::min(k, n - 1)];
    x[k] = p.x;
    y[k] = p.y;
    z[k] = p.z;
  }
  for (const auto& [at, scaled] : charges) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double dx = x[k] - at.x, dy = y[k] - at.y, dz = z[k] - at.z,
                   distance = std::sqrt(dx * dx + dy * dy + dz * dz);
      r[k] = distance < 0.5 ? 0.5 : distance;
      sums.vacuum[k] += scaled / r[k];
      sums.screened[k] += scaled / (r[k] * r[k]);
      nearest = r[k] < nearest ? r[k] : nearest;
    }
    constexpr double kFar = 4 / kBeta;  // erfc(4) is 2e-8
    if (nearest >= kFar) continue;
    for (std::size_t k = 0; k < n; ++k) {
      if (r[k] < kFar) sums.direct[k] += scaled * std::erfc(kBeta * r[k]) / r[k];
    }
  }
}

}  // namespace

MapSampler::MapSampler(const Grid& map) : map_(map) {
  const auto& step = map.lattice.step;
  const double volume = dot(step[0], cross(step[1], step[2]));
  for (std::size_t axis = 0; axis < 3; ++axis)
    reciprocal_[axis] = (1 / volume) * cross(step[(axis + 1) % 3], step[(axis + 2) % 3]);
}

double MapSampler::operator()(const Vec3d& p) const {
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
    const auto nx = static_cast<std::size_t>(map_.lattice.size[0]), ny = static_cast<std::size_t>(map_.lattice.size[1]);
    if (weight != 0) sum += weight * static_cast<double>(map_.values[at[0] + nx * (at[1] + ny * at[2])]);
  }
  return sum;
}

const char* to_string(ReferenceKind kind) {
  switch (kind) {
    case ReferenceKind::kSolvent: return "salt water";
    case ReferenceKind::kVacuum: return "vacuum";
    case ReferenceKind::kSmoothVacuum: return "vacuum, smooth part";
    case ReferenceKind::kDistanceDependent: break;
  }
  return "distance-dependent dielectric";
}

std::string in_words(const MapCheck& check) {
  return check.is_vacuum() ? std::string("given map in ") + to_string(check.kind)
                           : std::string("given map as in ") + to_string(check.kind);
}

MapReferences::MapReferences(Engine& engine, const Molecule& molecule, const RigidTransform& to_common,
                             const Surface& surface, float isovalue, double temperature_K, const Progress& progress)
    : engine_(engine),
      molecule_(molecule),
      temperature_K_(temperature_K),
      // kT A / e^2; as coulomb_potential()
      coulomb_(332.0636 / (temperature_K * 0.001987191)) {
  n_charges_ = static_cast<std::size_t>(
      std::count_if(molecule.charges.begin(), molecule.charges.end(), [](float q) { return q != 0; }));
  if (n_charges_ < kLeastCharges) return;
  const Mesh mesh = engine.download(surface.mesh);
  std::vector<Vec3f> near;
  const std::size_t stride = mesh.positions.size() / kCheckPoints + 1;
  for (std::size_t v = 0; v < mesh.positions.size(); v += stride)
    near.push_back(mesh.positions[v] + static_cast<float>(kCheckDistance_A) * mesh.normals[v]);
  const std::vector<float> density = engine.density_at(surface.atoms, near);
  std::vector<Vec3d> common;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (density[i] < isovalue) common.push_back(static_cast<Vec3d>(near[i]));
  }
  points_ = at_points(common, inverse(to_common));
  const std::vector<Vec3d> positions = at_points(molecule.positions, to_common);
  PoissonBoltzmannOptions options;
  options.tolerance = kCoarseTolerance;
  options.temperature_K = temperature_K;
  options.dielectric_boundary = DielectricBoundary::kVanDerWaals;  // half the time; slopes change by a few percent
  options.far_boundary = FarBoundary::kDebyeHueckel;               // read near the atoms only
  try {
    const Lattice lattice = poisson_boltzmann_lattice(positions, molecule.radii, kCoarse_A, kCoarsePadding_A);
    const Grid grid = engine.download(engine.poisson_boltzmann(positions, molecule.radii, molecule.charges, lattice,
                                                               options, {}, nullptr, progress, nullptr));
    const MapSampler sample(grid);
    for (const Vec3d& p : common) solvent_.push_back(sample(p));
  } catch (const InputError&) {
    solvent_.clear();  // charges without radii: the other references remain
  }
}

const MapReferences::Sums& MapReferences::sums_of_charges() const {
  if (sums_) return *sums_;
  const std::vector<double> zero(points_.size(), 0);
  sums_ = Sums{zero, zero, zero};
  Sums& sums = *sums_;
  std::vector<PointCharge> charges;
  for (std::size_t a = 0; a < molecule_.size(); ++a) {
    const double q = static_cast<double>(molecule_.charges[a]);
    if (q != 0) charges.push_back({molecule_.positions[a], coulomb_ * q});
  }
  const auto n_blocks = static_cast<std::ptrdiff_t>((points_.size() + kLanes - 1) / kLanes);
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t block = 0; block < n_blocks; ++block) {
    const std::size_t first = static_cast<std::size_t>(block) * kLanes, n = std::min(kLanes, points_.size() - first);
    BlockSums of_block;
    sum_charges(charges, &points_[first], n, of_block);
    for (std::size_t k = 0; k < n; ++k) {
      sums.vacuum[first + k] = of_block.vacuum[k];
      sums.screened[first + k] = of_block.screened[k];
      sums.direct[first + k] = of_block.direct[k];
    }
  }
  return sums;
}

/// [point] The smooth potential in the cell that the map's lattice covers, as those of PME's maps do.
std::vector<double> MapReferences::periodic(const Grid& map) const {
  PmeCell cell;
  PmeOptions options;
  options.ewald_factor = kBeta;
  options.temperature_K = temperature_K_;
  cell.centre = map.lattice.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = map.lattice.size[axis];
    cell.edges[axis] = n * map.lattice.step[axis];
    cell.centre += 0.5 * (n - 1) * map.lattice.step[axis];
    constexpr double kLeast = 8;
    options.size[axis] =
        2 * static_cast<int>(std::max(kLeast, std::ceil(norm(cell.edges[axis]) / (2 * kSmoothSpacing_A))));
  }
  Grid smooth =
      engine_.download(engine_.pme_potential(molecule_.positions, molecule_.charges, cell, options, {}, Progress()));
  smooth.periodic = true;
  const MapSampler sample(smooth);
  std::vector<double> values;
  for (const Vec3d& p : points_) values.push_back(sample(p));
  return values;
}

std::optional<MapCheck> MapReferences::check(const Grid& map) const {
  std::vector<double> values;
  const MapSampler sample(map);
  const double factor =
      map.unit == PotentialUnit::kUnknown ? 1 : conversion_factor(map.unit, PotentialUnit::kKtPerE, temperature_K_);
  MapCheck check;
  check.n_charges = n_charges_;
  for (const Vec3d& p : points_) {
    values.push_back(factor * sample(p));
    if (std::isfinite(values.back())) ++check.n_points;
  }
  if (n_charges_ < kLeastCharges || 2 * check.n_points < points_.size()) return std::nullopt;
  auto& [solvent, vacuum, smooth, screened] = check.fits;
  vacuum = smooth = screened = {kNaN, kNaN};
  solvent = fit(values, solvent_);
  const bool usual = solvent.slope < kSolventFactor && solvent.slope > 1 / kSolventFactor;
  if (usual && solvent.correlation > kSure) return check;
  const Sums& sums = sums_of_charges();
  const auto with = [](std::vector<double> a, const std::vector<double>& b, double sign) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += sign * b[i];
    return a;
  };
  vacuum = fit(values, sums.vacuum);
  smooth = fit(values, with(sums.vacuum, sums.direct, -1));
  screened = fit(values, sums.screened);
  const auto best_of = [&] {
    std::size_t best = 0;
    for (std::size_t k = 1; k < kReferenceKinds; ++k)
      if (is_better(check.fits[k], check.fits[best])) best = k;
    return static_cast<ReferenceKind>(best);
  };
  // Without salt a potential in water is nearly Coulomb's law with the dielectric of water.
  if (usual && solvent.correlation >= kLeastMapCorrelation) return check;
  check.kind = best_of();
  if (check.kind == ReferenceKind::kSolvent && check.best().correlation > kSure) return check;
  const std::vector<double> in_cell = periodic(map);
  const ReferenceFit smooth_in_cell = fit(values, in_cell), full = fit(values, with(in_cell, sums.direct, 1));
  if (is_better(smooth_in_cell, smooth)) smooth = smooth_in_cell;
  if (is_better(full, vacuum)) vacuum = full;
  check.kind = best_of();
  return check;
}

}  // namespace espdiff
