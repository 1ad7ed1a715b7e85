// density.h: the Gaussian density of the atoms on a lattice.
#pragma once

#include <memory>

#include "cuda/surface/density/atom_cells.h"
#include "cuda/surface/density/grid.h"

namespace espdiff::ESPDIFF_BACKEND {

/// A lattice that holds every atom's reach plus one layer, so that the density vanishes on its border.
/// @throws InputError (spacing not positive), MemoryError
CubicLattice density_lattice(const AtomCells& atoms, double spacing_A);

/// The density on the lattice, gathered point by point over the atoms in reach. Runs on both back ends.
std::shared_ptr<DensityGrid> density_by_points(const AtomCells& atoms, const CubicLattice& lattice);

#if !defined(ESPDIFF_BACKEND_CUDA)
/// The same bits, slab by slab: each atom adds its separable Gaussian to the rows of the slab. Suits a CPU's caches and
/// vector units.
std::shared_ptr<DensityGrid> density_by_slabs(const AtomCells& atoms, const CubicLattice& lattice);
#endif

}  // namespace espdiff::ESPDIFF_BACKEND
