// pb_checks.h: what poisson_boltzmann() refuses.
#pragma once

#include <vector>

#include "cuda/potential/pb/multigrid/multigrid.h"
#include "cuda/surface/density/grid.h"
#include "engine/poisson_boltzmann.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Bytes of device memory for each grid point: four coefficients, x, the three arrays of the solver and one that it may
/// add; the multigrid's; for the nonlinear equation five arrays more; a map to start from or to focus from.
inline double pb_bytes_per_point(const PoissonBoltzmannOptions& options) {
  return 4 * 4 + 5 * 4 + Multigrid::kBytesPerPoint + (options.nonlinear ? 5 * 4 : 0) + 4;
}

/// @throws InputError (numbers of values, values that are not finite, no charges, a negative radius, a charge without
/// radius outside all atoms)
void check_pb_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                    const std::vector<float>& charges);
/// @throws InputError naming the parameter, its value and what is usual
void check_pb_options(const PoissonBoltzmannOptions& options);
/// Of a solution on the lattice. @param spacing_A the user's, which the message says how to change
/// @throws MemoryError
void require_pb_memory(const Lattice& lattice, double spacing_A, const PoissonBoltzmannOptions& options);
/// @throws InputError (not cubic along the axes, too few points, an atom outside), MemoryError
CubicLattice checked_pb_lattice(const Lattice& lattice, const std::vector<Vec3d>& positions,
                                const PoissonBoltzmannOptions& options);

}  // namespace espdiff::ESPDIFF_BACKEND
