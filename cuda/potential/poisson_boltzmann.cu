// poisson_boltzmann.cu: from atoms to the potential: sets up the equation on the grid and has it solved.
#include "cuda/potential/poisson_boltzmann.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "cuda/potential/coulomb.h"
#include "cuda/potential/conjugate_gradients.h"
#include "cuda/potential/debye_hueckel.h"
#include "cuda/potential/dielectric_map.h"
#include "cuda/potential/pb_checks.h"
#include "cuda/potential/spread.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Ions of one kind in a cubic Angstrom, of 1 mol/l: Avogadro's number, 6.02214076e23 (CODATA 2018), times 1e-27.
constexpr double kIonsPerA3 = 6.02214076e-4;

/// The equation's constants; see docs/potentials.md.
struct Constants {
  double coulomb;      ///< C, kT A / e^2
  double kappa_bar_2;  ///< eps_solvent kappa^2 = 8 pi C c, 1/A^2
  double kappa;        ///< 1/A
};

Constants constants_of(const PoissonBoltzmannOptions& o) {
  Constants c{};
  c.coulomb = coulomb_in_kt(o.temperature_K);
  c.kappa_bar_2 = 8 * kPi * c.coulomb * kIonsPerA3 * o.ionic_strength_M;
  c.kappa = std::sqrt(c.kappa_bar_2 / o.solvent_dielectric);
  return c;
}

/// Atoms in an order that depends on nothing but themselves, so that theirs in the input changes no bit.
std::vector<PbAtom> sorted_atoms(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                                 const std::vector<float>& charges) {
  std::vector<PbAtom> atoms;
  for (std::size_t i = 0; i < positions.size(); ++i) atoms.push_back({positions[i], radii[i], charges[i]});
  std::sort(atoms.begin(), atoms.end(), [](const PbAtom& a, const PbAtom& b) {
    for (int axis = 2; axis >= 0; --axis) {
      if (a.position[axis] != b.position[axis]) return a.position[axis] < b.position[axis];
    }
    return a.radius != b.radius ? a.radius < b.radius : a.charge < b.charge;
  });
  return atoms;
}

std::vector<PbAtom> with_radius(const std::vector<PbAtom>& atoms) {
  std::vector<PbAtom> kept;
  std::copy_if(atoms.begin(), atoms.end(), std::back_inserter(kept), [](const PbAtom& a) { return a.radius > 0; });
  return kept;
}

/// b = 4 pi C q / h, the charges spread by cubic B-splines.
Buffer<float> right_hand_side(const std::vector<PbAtom>& atoms, const CubicLattice& lattice, double coulomb) {
  std::vector<GridCharge> placed;
  const double h = static_cast<double>(lattice.spacing), scale = 4 * kPi * coulomb / h;
  for (const PbAtom& atom : atoms) {
    if (atom.charge == 0) continue;
    GridCharge c{};
    for (int axis = 0; axis < 3; ++axis)
      c.u[axis] = (atom.position[axis] - static_cast<double>(lattice.origin[axis])) / h;
    c.charge = static_cast<float>(scale * static_cast<double>(atom.charge));
    placed.push_back(c);
  }
  constexpr int kCubic = 4;
  const auto sorted =
      sort_charges<float>(std::move(placed), {lattice.size[0], lattice.size[1], lattice.size[2]}, kCubic);
  Buffer<float> b(lattice.n_points());
  const std::size_t plane = lattice.index(0, 0, 1);
#if defined(ESPDIFF_BACKEND_CUDA)
  spread_by_points(sorted, raw(b), plane);
#else
  spread_by_slabs(sorted, raw(b), plane);
#endif
  return b;
}

}  // namespace

std::shared_ptr<MapGrid> poisson_boltzmann(const std::vector<Vec3d>& positions, const std::vector<float>& radii,
                                           const std::vector<float>& charges, const Lattice& on_lattice,
                                           const PoissonBoltzmannOptions& options, const RigidTransform& to_map,
                                           const MapGrid* start, const Progress& progress,
                                           PoissonBoltzmannReport* report) {
  check_pb_atoms(positions, radii, charges);
  check_pb_options(options);
  const CubicLattice lattice = checked_pb_lattice(on_lattice, positions, options);
  const std::vector<PbAtom> atoms = sorted_atoms(positions, radii, charges);
  const Constants constants = constants_of(options);
  const double h = static_cast<double>(lattice.spacing);

  progress.report("potential", 0.0);
  GridOperator on_grid;
  fill_operator(with_radius(atoms), lattice, options, static_cast<float>(h * h * constants.kappa_bar_2), on_grid);
  progress.report("potential", 0.1);
  const Buffer<float> b = right_hand_side(atoms, lattice, constants.coulomb);
  auto map = std::make_shared<MapGrid>();
  map->values.assign(lattice.n_points(), 0.0F);
  set_debye_hueckel_border(atoms, lattice, {constants.coulomb / options.solvent_dielectric, constants.kappa},
                           map->values);
  progress.report("potential", 0.2);

  Multigrid multigrid(on_grid);
  SolverWork work(lattice.n_points());
  SolverOptions solver;
  solver.tolerance = options.tolerance;
  solver.max_cycles = options.max_cycles;
  solver.norm = std::sqrt(dot_product(b, b));
  const SolverReport solved =
      conjugate_gradients(on_grid, multigrid, b, solver, work, map->values, [&](double residual) {
        progress.report("potential", 0.2 + 0.8 * std::min(1.0, std::max(0.0, std::log(residual) / std::log(options.tolerance))));
      });
  if (!solved.converged) throw ConvergenceError("did not converge");

  map->lattice = on_lattice;
  map->unit = PotentialUnit::kKtPerE;
  map->cubic = getenv("PB_LINEAR") == nullptr;
  set_index_transform(map->lattice, to_map, "the potential", map->to_index);
  if (report != nullptr) {
    report->relative_residual = solved.relative_residual;
    report->cycles = solved.cycles;
    report->levels = multigrid.n_levels();
    report->bytes_per_point = kPbBytesPerPoint;
    report->debye_length_A = 1 / constants.kappa;
    for (const PbAtom& atom : atoms) {
      report->net_charge += static_cast<double>(atom.charge);
      report->n_charges += atom.charge != 0 ? 1 : 0;
    }
  }
  return map;
}

}  // namespace espdiff::ESPDIFF_BACKEND
