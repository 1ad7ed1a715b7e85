// dielectric_map.h: from atoms to the coefficients of the Poisson-Boltzmann operator: dielectric of the faces between
// grid points, and where ions may be.
//
// DielectricSmoothing::kEdges: a face's dielectric is the harmonic mean along the edge between its two grid points,
// weighted by the part of the edge in the solute (Davis and McCammon, J. Comput. Chem. 12, 909 (1991)).
// DielectricSmoothing::kNinePoint: each face's centre is in the solute or in the solvent; a face's dielectric is the
// harmonic mean over itself and the eight faces around it (Bruccoleri et al., J. Comput. Chem. 18, 268 (1997); APBS'
// `smol`).
#pragma once

#include <memory>
#include <vector>

#include "cuda/potential/pb/multigrid/multigrid.h"
#include "cuda/potential/pb_atoms.h"
#include "cuda/potential/probe_positions.h"
#include "cuda/surface/density/grid.h"
#include "engine/poisson_boltzmann.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Depth of points below the solute's surface, Angstrom; negative in the solvent.
///
/// The depth is the distance to the nearest allowed position of the probe's centre, minus the probe's radius.
/// Candidates are the point's projections onto enlarged spheres that lie in no other one, and the points on the arcs
/// (probe_positions.h gives their accuracy). Next to the surface the depth is exact; deep inside it is only large.
/// Without a probe: the depth below the union of the spheres.
class SoluteShape {
 public:
  /// @param atoms with a positive radius each
  SoluteShape(const std::vector<PbAtom>& atoms, float probe_radius);
  /// [point] exact within a lattice step of the surface; elsewhere at least the sign is right.
  void depths(const CubicLattice& lattice, Buffer<float>& depths) const;
  /// The same, one thread per point (device).
  void depths_by_points(const CubicLattice& lattice, Buffer<float>& depths) const;
#if !defined(ESPDIFF_BACKEND_CUDA)
  /// The same, plane by plane (CPU).
  void depths_by_planes(const CubicLattice& lattice, Buffer<float>& depths) const;
#endif

 private:
  float probe_;
  ProbeAtoms atoms_;
  std::shared_ptr<AtomCells> probes_;
};

/// Sets the faces' dielectrics, and the diagonal to k alone. Call add_faces_to_diagonal() next.
/// @param stern_k k of points that ions can reach: h^2 kappa_bar^2
/// @param shape   the solute's, made where it is null: several grids of the same atoms need it once; null: not kept
void fill_operator(const std::vector<PbAtom>& atoms, const CubicLattice& lattice,
                   const PoissonBoltzmannOptions& options, float stern_k, GridOperator& on_grid,
                   std::shared_ptr<const SoluteShape>* shape = nullptr);

}  // namespace espdiff::ESPDIFF_BACKEND
