// coulomb.h: Coulomb's law summed over all charges at every point of a lattice (see Engine::coulomb_potential).
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "cuda/surface/sample.h"
#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {

std::shared_ptr<MapGrid> coulomb_potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                           const Lattice& lattice, const CoulombOptions& options,
                                           const Progress& progress);

/// See Engine::isolated_charges().
std::shared_ptr<MapGrid> isolated_charges(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                          const CoulombOptions& options, const RigidTransform& to_map);

/// Coulomb's constant over k_B T, kT A / e^2: 332.0636 kcal A / (mol e^2) and 0.001987191 kcal / (mol K), as PMEPot and
/// NAMD have them.
inline double coulomb_in_kt(double temperature_K) { return 332.0636 / (temperature_K * 0.001987191); }

/// @throws InputError unless there is a charge for each atom, all values are finite, and some charge is not zero
void check_charges(const std::vector<Vec3d>& positions, const std::vector<float>& charges);
/// @throws InputError unless positive and finite
void check_temperature(double temperature_K);

}  // namespace espdiff::ESPDIFF_BACKEND
