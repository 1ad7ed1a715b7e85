// poisson_boltzmann.h: parameters and report of a Poisson-Boltzmann potential.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/types.h"

namespace espdiff {

/// Where the solute's dielectric ends and the solvent's begins.
enum class DielectricBoundary {
  kMolecular,    ///< the solvent-excluded surface of the probe
  kVanDerWaals,  ///< the atoms' spheres
  kGaussian      ///< none: a smooth dielectric (Li et al., J. Chem. Theory Comput. 9, 2126 (2013))
};

/// How a sharp boundary is discretized.
enum class DielectricSmoothing {
  kEdges,     ///< harmonic mean along the edge between two grid points, by where the boundary cuts it
  kNinePoint  ///< harmonic mean of nine samples around its middle, as APBS' `smol`; has three times the error
};

/// Values on the grid's border.
enum class FarBoundary {
  kDebyeHueckel,  ///< the sum of all charges' Debye-Hueckel potentials in solvent (APBS' `mdh`)
  kFocus  ///< the potential on a grid of twice the spacing that reaches 20 A beyond the atoms, with that sum there
};

/// Parameters of Engine::poisson_boltzmann(). The defaults are those of APBS' examples, except temperature and border.
struct PoissonBoltzmannOptions {
  double solute_dielectric = 2;
  double solvent_dielectric = 78.54;
  double ionic_strength = 0.15;  ///< mol/l of a 1:1 salt
  double ion_radius_A = 2;       ///< ions stay this far outside every atom's sphere (Stern layer)
  double probe_radius_A = 1.4;   ///< of DielectricBoundary::kMolecular
  double gaussian_sigma = 0.93;  ///< of DielectricBoundary::kGaussian: an atom's Gaussian over its radius
  double temperature_K = 300;
  DielectricBoundary dielectric_boundary = DielectricBoundary::kMolecular;
  DielectricSmoothing smoothing = DielectricSmoothing::kEdges;
  FarBoundary far_boundary = FarBoundary::kFocus;
  bool nonlinear = false;  ///< sinh(phi) instead of phi for the ions
  /// Of the error that the iteration leaves at the surface, relative to the potential's rms there. Of the nonlinear
  /// equation, and where there is no boundary: of the residual's norm, relative to the right-hand side's.
  double tolerance = 1e-4;
  int max_cycles = 100;       ///< of multigrid-preconditioned conjugate gradients; for each Newton step
  int max_newton_steps = 50;  ///< of the nonlinear equation
  /// For contributions(): keeps the linear equation's coefficients, a byte a point, and solves it to what the sum of
  /// the contributions can be compared with, if that is more exact than `tolerance`.
  bool keep_operator = false;
};

/// How a potential was computed.
struct PoissonBoltzmannReport {
  double start_residual = 0;     ///< |b - A phi| / |b| of the start
  double relative_residual = 0;  ///< the same at the end, in double precision
  double surface_error = 0;      ///< what `tolerance` is of, as estimated at the end; never above it
  int cycles = 0;                ///< of conjugate gradients, all steps together
  int newton_steps = 0;          ///< 0 for the linearized equation
  int levels = 0;                ///< of the multigrid; 0 for the nonlinear equation, which makes a new one in each step
  double bytes_per_point = 0;    ///< of device memory, at most
  double net_charge = 0;         ///< elementary charges
  std::size_t n_charges = 0;     ///< that are not zero
  double debye_length_A = 0;     ///< infinite without salt
};

/// Defaults. At 0.5 A a surface's potentials differ by 1 % from those at 0.25 A. 6 A of solvent around the atoms with
/// FarBoundary::kFocus change them by at most 0.1 % up to 3 A outside (docs/potentials.md).
constexpr double kUsualPbSpacing_A = 0.5, kUsualPbPadding_A = 6;
/// Of maps that are written, and of FarBoundary::kDebyeHueckel, which then errs by 0.4 to 1.5 % at 3 A.
constexpr double kWidePbPadding_A = 12;

/// A cubic lattice for Engine::poisson_boltzmann() along the axes of the atoms' frame: it reaches `padding_A` beyond
/// every atom's sphere and is centred on their box. The numbers of points are multiples of eight plus one, for the
/// multigrid; the steps are exactly `spacing_A`.
/// @param radii [atom] Angstrom
/// @throws InputError (spacing or padding, no atoms, positions that are not finite, more than 2e9 points)
Lattice poisson_boltzmann_lattice(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                                  double spacing_A, double padding_A);

}  // namespace espdiff
