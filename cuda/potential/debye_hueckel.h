// debye_hueckel.h: the sum of all charges' Debye-Hueckel potentials on a grid's border.
#pragma once

#include <vector>

#include "cuda/potential/pb_atoms.h"
#include "cuda/surface/density/grid.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Constants of the border's potential.
struct DebyeHueckel {
  double scale = 0;      ///< C / eps_solvent, kT A / e^2
  double kappa = 0;      ///< inverse Debye length
  double every_A = 2.5;  ///< distance between the points of a face at which the sum is evaluated
  double nodes_A = 0;    ///< of FarCharges, where all faces are far from the atoms
};

/// Sets the border of `phi` [point] to
///
///     phi(x) = scale sum_i q_i exp(-kappa (r - a_i)) / ((1 + kappa a_i) r),   r = |x - x_i|, a_i the atom's radius
///
/// (APBS' `mdh`). The sum is evaluated every `every_A` on each face, and interpolated by cubics in between; where there
/// are `nodes_A`, from the charges that these have.
void set_debye_hueckel_border(const std::vector<PbAtom>& atoms, const CubicLattice& lattice, const DebyeHueckel& law,
                              Buffer<float>& phi);

/// The transpose: [atom] what a unit charge at each atom adds to sum_p gradient(p) phi(p) over the border's points.
/// @param gradient [point] its border is used up
std::vector<double> debye_hueckel_transposed(const std::vector<PbAtom>& atoms, const CubicLattice& lattice,
                                             const DebyeHueckel& law, Buffer<float>& gradient);

}  // namespace espdiff::ESPDIFF_BACKEND
