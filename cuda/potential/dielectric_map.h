// dielectric_map.h: from atoms to the coefficients of the Poisson-Boltzmann operator: dielectric of the faces between
// grid points, and where ions may be.
//
// A face's middle is inside the solute or not; its dielectric is the harmonic mean over itself and the eight faces
// around it (Bruccoleri et al., J. Comput. Chem. 18, 268 (1997); APBS' `smol`).
#pragma once

#include <vector>

#include "engine/poisson_boltzmann.h"
#include "cuda/surface/grid.h"
#include "cuda/potential/multigrid.h"
#include "cuda/potential/pb_atoms.h"
#include "cuda/potential/probe_positions.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Where a point lies. The solute is what no probe reaches.
enum PointState : std::uint8_t { kSolvent = 0, kWithinProbe = 1, kSolute = 2 };

/// [point] state of the points of a lattice. The solvent-excluded solute is exact but for what probe_positions.h says of
/// arcs; without a probe, the union of the spheres.
///
/// A point within an enlarged sphere, but in no atom, is solvent where its projection onto that sphere lies in no other
/// one (the probe may stand there), or where a point of an arc lies within the probe's radius.
/// @param atoms with a positive radius each
class SoluteShape {
 public:
  SoluteShape(const std::vector<PbAtom>& atoms, float probe_radius);
  void states(const CubicLattice& lattice, Buffer<std::uint8_t>& states) const;
  /// The same, each point for itself (device).
  void states_by_points(const CubicLattice& lattice, Buffer<std::uint8_t>& states) const;
#if !defined(ESPDIFF_BACKEND_CUDA)
  /// The same, atoms and probes into plane after plane.
  void states_by_planes(const CubicLattice& lattice, Buffer<std::uint8_t>& states) const;
#endif

 private:
  float probe_;
  ProbeAtoms atoms_;
  std::shared_ptr<AtomCells> probes_;
};

/// Sets the faces' dielectric and the diagonal, at first to k, then to all of it.
/// @param stern_k what a point has where ions may be: h^2 kappa_bar^2
void fill_operator(const std::vector<PbAtom>& atoms, const CubicLattice& lattice,
                   const PoissonBoltzmannOptions& options, float stern_k, GridOperator& on_grid);

}  // namespace espdiff::ESPDIFF_BACKEND
