// coulomb.cu: Coulomb's law summed over all charges at every point of a lattice, plane by plane.
#include "cuda/potential/coulomb.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "base/progress.h"
#include "base/work.h"
#include "cuda/potential/map_origin.h"
#include "engine/potential_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

void check(const CoulombOptions& options) {
  if (!(options.dielectric > 0) || !std::isfinite(options.dielectric))
    throw InputError("dielectric constant " + formatted(options.dielectric) +
                     " is not a positive number; 1 is vacuum, 4 r is usual in proteins, 80 is water");
  check_temperature(options.temperature_K);
}

void check(const Lattice& lattice) {
  double n_points = 1;
  for (const int n : lattice.size) {
    if (n < 1) throw InputError("a lattice of " + std::to_string(n) + " points along an axis; at least 1 is needed");
    n_points *= n;
  }
  require_grid(n_points, sizeof(float), "a Coulomb potential");
}

}  // namespace

void check_charges(const std::vector<Vec3d>& positions, const std::vector<float>& charges) {
  if (positions.size() != charges.size())
    throw InputError(std::to_string(positions.size()) + " positions but " + std::to_string(charges.size()) +
                     " charges; give one charge for each atom");
  bool any = false;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3d& p = positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw InputError("atom " + std::to_string(i + 1) + " has a coordinate that is not finite");
    if (!std::isfinite(charges[i]))
      throw InputError("atom " + std::to_string(i + 1) + " has a charge that is not finite");
    any = any || charges[i] != 0;
  }
  if (!any)
    throw InputError("none of the " + std::to_string(positions.size()) +
                     " atoms has a charge; take charges from a topology (PSF, prmtop) or a PQR file");
}

void check_temperature(double temperature_K) {
  if (temperature_K > 0 && std::isfinite(temperature_K)) return;
  throw InputError("temperature " + formatted(temperature_K) + " K is not a positive number; 300 is usual");
}

std::shared_ptr<MapGrid> coulomb_potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                           const Lattice& lattice, const CoulombOptions& options,
                                           const Progress& progress) {
  check_charges(positions, charges);
  check(options);
  check(lattice);
  const double n_points = static_cast<double>(lattice.n_points()), n_atoms = static_cast<double>(positions.size());
  require_work(n_atoms * n_points,
               "Coulomb's law of " + formatted(n_atoms) + " atoms at " + formatted(n_points) + " points",
               "give a coarser grid, or take the potential pme");
  auto map = std::make_shared<MapGrid>();
  map->lattice = lattice;
  map->unit = PotentialUnit::kKtPerE;
  set_index_transform(lattice, {}, "the lattice", map->to_index);
  map->values.resize(lattice.n_points());

  const ChargeSums sums(positions, charges, coulomb_in_kt(options.temperature_K) / options.dielectric,
                        options.distance_dependent);
  const ChargeSumsView view = sums.view();
  float* const out = raw(map->values);
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]),
                    plane = nx * static_cast<std::size_t>(lattice.size[1]);
  const Vec3d a = lattice.step[0], b = lattice.step[1];
  for (int z = 0; z < lattice.size[2]; ++z) {
    progress.report("potential", static_cast<double>(z) / lattice.size[2]);
    const Vec3d corner = lattice.origin + static_cast<double>(z) * lattice.step[2];
    float* const values = out + plane * static_cast<std::size_t>(z);
    for_each_index(plane, [=] ESPDIFF_HD(std::size_t i) {
      const std::size_t y = i / nx;
      const Vec3d p = corner + static_cast<double>(i % nx) * a + static_cast<double>(y) * b;
      values[i] = static_cast<float>(view.isolated(p));
    });
  }
  progress.report("potential", 1.0);
  return map;
}

std::shared_ptr<MapGrid> isolated_charges(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                          const CoulombOptions& options, const RigidTransform& to_map) {
  check_charges(positions, charges);
  check(options);
  auto map = std::make_shared<MapGrid>();
  // Lattice coordinates are those of the charges' frame, Angstrom.
  map->lattice.step = {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  map->unit = PotentialUnit::kKtPerE;
  set_index_transform(map->lattice, to_map, "the charges' frame", map->to_index);
  map->charge_sums = std::make_shared<ChargeSums>(
      positions, charges, coulomb_in_kt(options.temperature_K) / options.dielectric, options.distance_dependent);
  auto origin = std::make_shared<MapOrigin>();
  origin->method = PotentialMethod::kCoulomb;
  origin->positions = positions;
  origin->to_map = to_map;
  origin->charges = charges;
  origin->coulomb = options;
  map->origin = std::move(origin);
  return map;
}

}  // namespace espdiff::ESPDIFF_BACKEND
