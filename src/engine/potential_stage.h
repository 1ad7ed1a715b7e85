// potential_stage.h: parameters of potentials that an engine computes from charges.
#pragma once

#include <array>

#include "base/types.h"

namespace espdiff {

/// pme: point or smeared charges in a periodic cell, by particle-mesh Ewald. coulomb: point charges, isolated, summed
/// directly. pb: charges in a solute of low dielectric in salt water, by the Poisson-Boltzmann equation.
enum class PotentialMethod { kPme, kCoulomb, kPoissonBoltzmann };

/// A periodic cell: `edges` span it, `centre` lies in its middle. Angstrom.
struct PmeCell {
  Vec3d centre{};
  std::array<Vec3d, 3> edges{};
};

/// Grid points over a cell, symmetric about its centre: (0, 0, 0) lies at centre - sum_i (K_i - 1) / (2 K_i) edge_i,
/// and steps are edge_i / K_i. The same layout as PMEPot's.
inline Lattice lattice_over(const PmeCell& cell, const std::array<int, 3>& size) {
  Lattice lattice;
  lattice.size = size;
  lattice.origin = cell.centre;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = size[axis];
    lattice.step[axis] = (1.0 / n) * cell.edges[axis];
    lattice.origin += (-0.5 * (n - 1) / n) * cell.edges[axis];
  }
  return lattice;
}

enum class Precision { kSingle, kDouble };

/// Which part of Ewald's sum. kSmooth: the reciprocal part, charges smeared into Gaussians, as PMEPot gives it. kFull:
/// with the direct part, sum q erfc(beta r) / r, which is added where the map is sampled: the potential of point
/// charges.
enum class PmePart { kSmooth, kFull };

/// Parameters of pme_potential().
struct PmeOptions {
  std::array<int, 3> size{0, 0, 0};  ///< grid points along each edge
  double ewald_factor = 0.25;        ///< beta, 1/A: charges are smeared into Gaussians of variance 1 / (2 beta^2)
  int order = 6;                     ///< of the B-splines, 4 to 8; 4 with `compatible`
  Precision precision = Precision::kSingle;
  /// Reproduces VMD's PMEPot 1.0.4: the splines' factor squared, the volume truncated to whole A^3.
  bool compatible = false;
  /// Samples of the map use splines of `order` instead of trilinear interpolation, so they are as accurate between grid
  /// points as on them. Not with `compatible`.
  bool smooth_samples = false;
  PmePart part = PmePart::kSmooth;  ///< kFull not with `compatible`
  double temperature_K = 300;
};

/// Where the zero of a periodic potential lies, told by zero_in_bulk().
struct BulkZero {
  double fraction = 0;    ///< share of the cell's points that lie farther from the solute than the distance
  double mean_there = 0;  ///< kT/e; mean over them before the zero was moved
};

/// Parameters of coulomb_potential() and isolated_charges().
struct CoulombOptions {
  double dielectric = 1;            ///< epsilon, > 0
  bool distance_dependent = false;  ///< epsilon * r / (1 A) instead of epsilon
  double temperature_K = 300;
};

/// A weighted sum of a potential's samples, sum_v w_v sample(v); see Engine::contributions().
struct PotentialReading {
  std::vector<Vec3f> points;    ///< common frame, Angstrom
  std::vector<double> weights;  ///< [point]
  /// |sum w_v sample(v)| over sum |w_v sample(v)|, as far as it is known. What cancels is found more exactly.
  double share_left = 1;
};

/// A charge that a map is not made of; see Engine::contributions().
struct ProbeCharge {
  Vec3d position;    ///< Angstrom
  float radius = 0;  ///< Angstrom; pb: of the Debye-Hueckel values on the border
  float charge = 1;  ///< elementary charges
};

}  // namespace espdiff
