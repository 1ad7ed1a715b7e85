// map_origin.h: the charges and the parameters that a map was computed from, by which contributions() transposes it.
#pragma once

#include <memory>
#include <vector>

#include "engine/poisson_boltzmann.h"
#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

class PackedOperator;

struct MapOrigin {
  PotentialMethod method = PotentialMethod::kCoulomb;
  std::vector<Vec3d> positions;  ///< [atom] Angstrom, the map's frame
  std::vector<float> radii;      ///< [atom] of pb
  std::vector<float> charges;    ///< [atom] elementary charges
  CoulombOptions coulomb;
  PoissonBoltzmannOptions pb;
  std::shared_ptr<const PackedOperator> pb_operator;  ///< kept for contributions; null where it was not
  PmeCell cell;
  PmeOptions pme;
  RigidTransform to_map;  ///< from the frame of meshes into the map's
  /// Of zero_in_bulk(): the solute and its distance to the bulk; negative where the zero was not moved.
  std::vector<Vec3d> solute;
  double bulk_distance_A = -1;
};

}  // namespace espdiff::ESPDIFF_BACKEND
