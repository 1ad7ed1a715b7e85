// pb_problem.h: what the Poisson-Boltzmann potential and its transpose set up alike.
#pragma once

#include <memory>
#include <vector>

#include "cuda/potential/pb/multigrid/multigrid.h"
#include "cuda/potential/pb/multigrid/packed_operator.h"
#include "cuda/potential/pb_atoms.h"
#include "cuda/surface/density/grid.h"
#include "engine/poisson_boltzmann.h"

namespace espdiff::ESPDIFF_BACKEND {

struct DebyeHueckel;
class SoluteShape;
struct SolverReport;

/// The equation's constants; see docs/potentials.md.
struct PbConstants {
  double coulomb;      ///< C, kT A / e^2
  double kappa_bar_2;  ///< eps_solvent kappa^2 = 8 pi C c, 1/A^2
  double kappa;        ///< 1/A
};
PbConstants pb_constants(const PoissonBoltzmannOptions& options);

/// The residual that a potential has at most from which contributions are read.
constexpr double kResidualForReadings = 1e-6;

/// Of a border without the solute's dielectric.
DebyeHueckel border_law(const PbConstants& constants, const PoissonBoltzmannOptions& options);

/// Atoms sorted by position, so that their order in the input changes no bit.
std::vector<PbAtom> sorted_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                                 const std::vector<float>& charges);

/// The coefficients of the equation on a grid; its diagonal holds the ions' part alone.
/// @param shape as fill_operator()'s
void fill_pb_operator(const std::vector<PbAtom>& atoms, const CubicLattice& lattice, const PbConstants& constants,
                      const PoissonBoltzmannOptions& options, GridOperator& on_grid,
                      std::shared_ptr<const SoluteShape>* shape = nullptr);

/// The dielectrics and the k that most points have; see fill_pb_operator().
UsualCoefficients usual_coefficients(const CubicLattice& lattice, const PbConstants& constants,
                                     const PoissonBoltzmannOptions& options);

/// The factor of a charge on the right-hand side, 4 pi C / h.
inline double charge_scale(const CubicLattice& lattice, double coulomb) {
  return 4 * kPi * coulomb / static_cast<double>(lattice.spacing);
}

/// The grid whose potential a smaller one's border holds (FarBoundary::kFocus): twice the spacing, far beyond the atoms
/// and the other grid. Its points are multiples of its spacing, so that atoms at the same position in two molecules
/// have the same place between them.
Lattice wider_lattice(const Lattice& lattice, const std::vector<PbAtom>& atoms);
CubicLattice cubic_lattice(const Lattice& lattice);

/// @throws ConvergenceError unless the solver converged
void require_converged(const PoissonBoltzmannOptions& options, const SolverReport& solved, int newton_steps);

}  // namespace espdiff::ESPDIFF_BACKEND
