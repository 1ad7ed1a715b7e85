// dielectric_map.h: from atoms to the coefficients of the Poisson-Boltzmann operator: dielectric of the faces between
// grid points, and where ions may be.
//
// DielectricSmoothing::kEdges: a face's dielectric is the harmonic mean along the way between its two grid points, by
// the part of it that lies in the solute (Davis and McCammon, J. Comput. Chem. 12, 909 (1991)).
// DielectricSmoothing::kNinePoint: a face's middle lies in the solute or not, and its dielectric is the harmonic mean
// over itself and the eight faces around it (Bruccoleri et al., J. Comput. Chem. 18, 268 (1997); APBS' `smol`).
#pragma once

#include <vector>

#include "cuda/potential/multigrid.h"
#include "cuda/potential/pb_atoms.h"
#include "cuda/potential/probe_positions.h"
#include "cuda/surface/grid.h"
#include "engine/poisson_boltzmann.h"

namespace espdiff::ESPDIFF_BACKEND {

/// How deep points lie below the solute's surface, Angstrom; negative in the solvent.
///
/// A point inside an atom's enlarged sphere is as far from the accessible region as from the nearest of these: its
/// projections onto such spheres that lie in no other one (the probe may stand there), and the points of the arcs. Less
/// the probe's radius this is the depth below the solvent-excluded surface: exact next to the surface but for what
/// probe_positions.h says of arcs, and large deep inside. Without a probe: below the union of the spheres.
class SoluteShape {
 public:
  /// @param atoms with a positive radius each
  SoluteShape(const std::vector<PbAtom>& atoms, float probe_radius);
  /// [point], exact where within a step of the lattice from the surface, and else at least of the right sign.
  void depths(const CubicLattice& lattice, Buffer<float>& depths) const;
  /// The same, each point for itself (device).
  void depths_by_points(const CubicLattice& lattice, Buffer<float>& depths) const;
#if !defined(ESPDIFF_BACKEND_CUDA)
  /// The same, atoms and probes into plane after plane.
  void depths_by_planes(const CubicLattice& lattice, Buffer<float>& depths) const;
#endif

 private:
  float probe_;
  ProbeAtoms atoms_;
  std::shared_ptr<AtomCells> probes_;
};

/// Sets the faces' dielectric, and the diagonal to k alone: add_faces_to_diagonal() comes next.
/// @param stern_k what a point has where ions may be: h^2 kappa_bar^2
void fill_operator(const std::vector<PbAtom>& atoms, const CubicLattice& lattice,
                   const PoissonBoltzmannOptions& options, float stern_k, GridOperator& on_grid);

}  // namespace espdiff::ESPDIFF_BACKEND
