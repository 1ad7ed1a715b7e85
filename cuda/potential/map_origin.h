// map_origin.h: the charges and the parameters that a map was computed from, by which contributions() transposes it.
#pragma once

#include <memory>
#include <vector>

#include "engine/poisson_boltzmann.h"
#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

struct MapGrid;
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

/// The places of a map's charges, then those of the probes.
std::vector<Vec3d> charge_places(const MapOrigin& origin, const std::vector<ProbeCharge>& probes);

/// Turns what unit charges add into what the map's charges and the probes add.
void scale_by_charges(const MapOrigin& origin, const std::vector<ProbeCharge>& probes, std::vector<double>& of_unit);

std::shared_ptr<MapGrid> without_values(const MapGrid& map);

}  // namespace espdiff::ESPDIFF_BACKEND
