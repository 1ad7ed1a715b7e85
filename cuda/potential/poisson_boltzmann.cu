// poisson_boltzmann.cu: from atoms to the potential: sets up the equation on the grid and solves it.
#include "cuda/potential/poisson_boltzmann.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/potential/conjugate_gradients.h"
#include "cuda/potential/coulomb.h"
#include "cuda/potential/debye_hueckel.h"
#include "cuda/potential/dielectric_map.h"
#include "cuda/potential/newton.h"
#include "cuda/potential/pb_checks.h"
#include "cuda/potential/spread.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Ions of one kind per cubic Angstrom at 1 mol/l: Avogadro's number, 6.02214076e23 (CODATA 2018), times 1e-27.
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
  c.kappa_bar_2 = 8 * kPi * c.coulomb * kIonsPerA3 * o.ionic_strength;
  c.kappa = std::sqrt(c.kappa_bar_2 / o.solvent_dielectric);
  return c;
}

/// Atoms sorted by position, so that their order in the input changes no bit.
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

/// Sets the border of phi to trilinear samples of a wider map.
void set_border_from(const MapGrid& around, const CubicLattice& lattice, Buffer<float>& phi) {
  MapGrid in_its_frame;
  in_its_frame.lattice = around.lattice;
  in_its_frame.values = around.values;
  set_index_transform(around.lattice, {}, "the coarse grid", in_its_frame.to_index);
  const auto samples = resample(in_its_frame, host_lattice(lattice));
  const float* const from = raw(samples->values);
  float* const to = raw(phi);
  const int nx = lattice.size[0], ny = lattice.size[1], nz = lattice.size[2];
  for_each_index(phi.size(), [=] ESPDIFF_HD(std::size_t p) {
    const int i = static_cast<int>(p % static_cast<std::size_t>(nx)),
              j = static_cast<int>(p / static_cast<std::size_t>(nx) % static_cast<std::size_t>(ny)),
              k = static_cast<int>(p / (static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny)));
    const bool border = i == 0 || j == 0 || k == 0 || i == nx - 1 || j == ny - 1 || k == nz - 1;
    if (border) to[p] = from[p];
  });
}

/// phi = an earlier potential; zero outside it.
void start_from(const MapGrid& start, const Lattice& lattice, Buffer<float>& phi) {
  MapGrid in_its_frame;
  in_its_frame.lattice = start.lattice;
  in_its_frame.values = start.values;
  set_index_transform(start.lattice, {}, "the potential to start from", in_its_frame.to_index);
  const auto samples = resample(in_its_frame, lattice);
  const float* const from = raw(samples->values);
  float* const to = raw(phi);
  for_each_index(phi.size(), [=] ESPDIFF_HD(std::size_t p) { to[p] = is_finite(from[p]) ? from[p] : 0.0F; });
}

/// The same centre and number of points, twice the spacing.
Lattice twice_as_wide(Lattice lattice) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.origin += (-0.5 * (lattice.size[axis] - 1)) * lattice.step[axis];
    lattice.step[axis] = 2.0 * lattice.step[axis];
  }
  return lattice;
}

/// Inputs of a solution, on any grid.
struct Problem {
  const std::vector<PbAtom>& atoms;
  const PoissonBoltzmannOptions& options;
  Constants constants;
  const Progress& progress;
};

void throw_not_converged(const PoissonBoltzmannOptions& o, const SolverReport& solved, int steps) {
  if (o.nonlinear) {
    throw ConvergenceError(
        formatted("the nonlinear Poisson-Boltzmann equation did not converge: the relative residual is %.3g after %d "
                  "Newton steps and %d cycles, %.3g is asked for; use the linearized equation, or a smaller spacing",
                  solved.relative_residual, steps, solved.cycles, o.tolerance));
  }
  throw ConvergenceError(
      formatted("the Poisson-Boltzmann equation did not converge: the relative residual is %.3g after %d cycles, "
                "%.3g is asked for; allow more cycles, or a larger tolerance",
                solved.relative_residual, solved.cycles, o.tolerance));
}

/// Solves for phi, whose border is set, and fills the report.
void solve(const Problem& problem, const CubicLattice& lattice, Buffer<float>& phi, PoissonBoltzmannReport& report) {
  const PoissonBoltzmannOptions& options = problem.options;
  const double h = static_cast<double>(lattice.spacing);
  GridOperator on_grid;
  fill_operator(with_radius(problem.atoms), lattice, options, static_cast<float>(h * h * problem.constants.kappa_bar_2),
                on_grid);
  problem.progress.report("potential", 0.2);
  const Buffer<float> b = right_hand_side(problem.atoms, lattice, problem.constants.coulomb);
  SolverWork work(lattice.n_points());
  SolverOptions solver;
  solver.tolerance = options.tolerance;
  solver.max_cycles = options.max_cycles;
  solver.norm = std::sqrt(dot_product(b, b));
  const auto step = [&](double residual) {
    const double part = std::log(residual) / std::log(options.tolerance);
    problem.progress.report("potential", 0.2 + 0.8 * std::min(1.0, std::max(0.0, part)));
  };
  SolverReport solved;
  if (options.nonlinear && options.ionic_strength > 0) {
    const Buffer<float> k = on_grid.diagonal;
    const NewtonReport newton_report = newton(on_grid, k, b, solver, options.max_newton_steps, work, phi, step);
    solved = newton_report.solver;
    report.newton_steps = newton_report.steps;
  } else {
    add_faces_to_diagonal(on_grid);
    Multigrid multigrid(on_grid);
    report.levels = multigrid.n_levels();
    solved = conjugate_gradients(on_grid, multigrid, b, solver, work, phi, step);
  }
  report.relative_residual = solved.relative_residual;
  report.start_residual = solved.start_residual;
  report.cycles = solved.cycles;
  if (!solved.converged) throw_not_converged(options, solved, report.newton_steps);
}

void set_border(const Problem& problem, const Lattice& on_lattice, const CubicLattice& lattice, Buffer<float>& phi) {
  const DebyeHueckel law{problem.constants.coulomb / problem.options.solvent_dielectric, problem.constants.kappa};
  if (problem.options.far_boundary == FarBoundary::kDebyeHueckel) {
    set_debye_hueckel_border(problem.atoms, lattice, law, phi);
    return;
  }
  MapGrid around;
  around.lattice = twice_as_wide(on_lattice);
  CubicLattice wide = lattice;
  wide.origin = static_cast<Vec3f>(around.lattice.origin);
  wide.spacing *= 2;
  around.values.assign(lattice.n_points(), 0.0F);
  set_debye_hueckel_border(problem.atoms, wide, law, around.values);
  PoissonBoltzmannReport ignored;
  solve(problem, wide, around.values, ignored);
  set_border_from(around, lattice, phi);
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
  const Problem problem{atoms, options, constants_of(options), progress};
  auto map = std::make_shared<MapGrid>();
  map->lattice = on_lattice;
  map->unit = PotentialUnit::kKtPerE;
  set_index_transform(map->lattice, to_map, "the potential", map->to_index);
  map->values.assign(lattice.n_points(), 0.0F);
  progress.report("potential", 0.0);
  if (start != nullptr) start_from(*start, on_lattice, map->values);
  set_border(problem, on_lattice, lattice, map->values);
  progress.report("potential", 0.1);
  PoissonBoltzmannReport told;
  told.bytes_per_point = pb_bytes_per_point(options);
  told.debye_length_A = 1 / problem.constants.kappa;
  for (const PbAtom& atom : atoms) {
    told.net_charge += static_cast<double>(atom.charge);
    told.n_charges += atom.charge != 0 ? 1 : 0;
  }
  solve(problem, lattice, map->values, told);
  if (report != nullptr) *report = told;
  progress.report("potential", 1.0);
  return map;
}

}  // namespace espdiff::ESPDIFF_BACKEND
