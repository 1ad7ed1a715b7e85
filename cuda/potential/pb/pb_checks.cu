// pb_checks.cu: checks of a Poisson-Boltzmann problem's atoms, options and grid.
#include "cuda/potential/pb/pb_checks.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/device/memory.h"
#include "cuda/potential/coulomb.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

void require(bool holds, const std::string& what, double value, const std::string& unit, const std::string& rule) {
  if (holds && std::isfinite(value)) return;
  throw InputError(what + " " + formatted(value) + unit + " " + rule);
}

/// Refuses charges in the solvent, outside all spheres: their potential has no meaning.
void check_bare_charges(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                        const std::vector<float>& charges) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (charges[i] == 0 || radii[i] > 0) continue;
    bool inside = false;
    for (std::size_t j = 0; j < positions.size() && !inside; ++j)
      inside = radii[j] > 0 && norm(positions[j] - positions[i]) < static_cast<double>(radii[j]);
    if (inside) continue;
    throw InputError("atom " + std::to_string(i + 1) + " has a charge of " +
                     formatted(static_cast<double>(charges[i])) +
                     " and a radius of 0, and lies in no other atom: its charge would be bare in the solvent; give it "
                     "a radius");
  }
}

}  // namespace

void check_pb_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                    const std::vector<float>& charges) {
  check_charges(positions, charges);
  if (radii.size() != positions.size())
    throw InputError(std::to_string(positions.size()) + " positions but " + std::to_string(radii.size()) +
                     " radii; give one radius for each atom");
  bool any = false;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (!(radii[i] >= 0) || !std::isfinite(radii[i]))
      throw InputError("atom " + std::to_string(i + 1) + " has a radius of " +
                       formatted(static_cast<double>(radii[i])) + " A, which is not a number from 0 on");
    any = any || radii[i] > 0;
  }
  if (!any)
    throw InputError("none of the " + std::to_string(radii.size()) +
                     " atoms has a radius, so there is no solute; take radii from a PQR file");
  check_bare_charges(positions, radii, charges);
}

void check_pb_options(const PoissonBoltzmannOptions& o) {
  require(o.solute_dielectric > 0, "solute dielectric", o.solute_dielectric, "",
          "is not a positive number; 2 is usual");
  require(o.solvent_dielectric > 0, "solvent dielectric", o.solvent_dielectric, "",
          "is not a positive number; 78.54 is water's");
  require(o.ionic_strength >= 0, "ionic strength", o.ionic_strength, " mol/l",
          "is not a number from 0 on; 0.15 is usual");
  require(o.ion_radius_A >= 0, "ion radius", o.ion_radius_A, " A", "is not a number from 0 on; 2 is usual");
  require(o.probe_radius_A >= 0, "probe radius", o.probe_radius_A, " A", "is not a number from 0 on; 1.4 is water's");
  require(o.gaussian_sigma > 0, "Gaussian sigma", o.gaussian_sigma, "", "is not a positive number; 0.93 is usual");
  require(o.tolerance > 0 && o.tolerance < 1, "tolerance", o.tolerance, "", "is not between 0 and 1; 1e-4 is usual");
  require(o.max_cycles >= 1, "number of cycles", o.max_cycles, "", "is below 1; 100 is usual");
  require(o.max_newton_steps >= 1, "number of Newton steps", o.max_newton_steps, "", "is below 1; 50 is usual");
  check_temperature(o.temperature_K);
}

void require_pb_memory(const Lattice& lattice, double spacing_A, const PoissonBoltzmannOptions& options) {
  double n_points = 1;
  for (const int n : lattice.size) n_points *= n;
  const double per_point = pb_bytes_per_point(options), coarser = coarsening_to_fit(n_points, per_point);
  if (coarser <= 1) return;
  const std::string fits = formatted("%.2f", std::ceil(100 * spacing_A * coarser) / 100);
  throw MemoryError("a grid of " + std::to_string(lattice.size[0]) + " x " + std::to_string(lattice.size[1]) + " x " +
                    std::to_string(lattice.size[2]) + " points " + need_in_words(n_points, per_point) +
                    "; a spacing of " + fits + " A would fit");
}

CubicLattice checked_pb_lattice(const Lattice& lattice, const std::vector<Vec3d>& positions,
                                const PoissonBoltzmannOptions& options) {
  const double h = lattice.step[0].x;
  const Vec3d wanted[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(h > 0) || !std::isfinite(h) || norm(lattice.step[axis] - wanted[axis]) > 1e-6 * h)
      throw InputError("the Poisson-Boltzmann equation needs a cubic lattice along the axes");
  }
  constexpr int kFewest = 9;
  CubicLattice result{};
  for (int axis = 0; axis < 3; ++axis) {
    const int n = lattice.size[static_cast<std::size_t>(axis)];
    if (n < kFewest)
      throw InputError("a grid of " + std::to_string(lattice.size[0]) + " x " + std::to_string(lattice.size[1]) +
                       " x " + std::to_string(lattice.size[2]) + " points is too small; each axis needs at least " +
                       std::to_string(kFewest));
    result.size[axis] = n;
  }
  result.origin = static_cast<Vec3f>(lattice.origin);
  result.spacing = static_cast<float>(h);
  // Splines reach two points beyond a charge.
  constexpr double kMargin = 3;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double at = (positions[i][axis] - lattice.origin[axis]) / h;
      if (at < kMargin || at > result.size[axis] - 1 - kMargin)
        throw InputError("atom " + std::to_string(i + 1) + " lies outside the grid, or within " +
                         formatted(kMargin * h) + " A of its border; use a larger padding");
    }
  }
  require_pb_memory(lattice, h, options);
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
