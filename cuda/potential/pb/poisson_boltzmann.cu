// poisson_boltzmann.cu: from atoms to the potential: sets up the equation on the grid and solves it.
#include "cuda/potential/pb/poisson_boltzmann.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "cuda/potential/debye_hueckel.h"
#include "cuda/potential/map_origin.h"
#include "cuda/potential/pb/conjugate_gradients.h"
#include "cuda/potential/pb/dielectric_map.h"
#include "cuda/potential/pb/newton.h"
#include "cuda/potential/pb/pb_checks.h"
#include "cuda/potential/pb/pb_problem.h"
#include "cuda/potential/spread.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// b = 4 pi C q / h, the charges spread by cubic B-splines.
SortedCharges<double> charges_on_grid(const std::vector<PbAtom>& atoms, const CubicLattice& lattice, double coulomb) {
  std::vector<GridCharge> placed;
  const double h = static_cast<double>(lattice.spacing), scale = charge_scale(lattice, coulomb);
  for (const PbAtom& atom : atoms) {
    if (atom.charge == 0) continue;
    GridCharge c{};
    for (int axis = 0; axis < 3; ++axis)
      c.u[axis] = (atom.position[axis] - static_cast<double>(lattice.origin[axis])) / h;
    c.charge = scale * static_cast<double>(atom.charge);
    placed.push_back(c);
  }
  constexpr int kCubic = 4;
  return sort_charges<double>(to_device(placed), {lattice.size[0], lattice.size[1], lattice.size[2]}, kCubic);
}

/// Sets the border of phi to trilinear samples of a wider map.
void set_border_from(const MapGrid& around, const Lattice& lattice, Buffer<float>& phi) {
  const int nx = lattice.size[0], ny = lattice.size[1], nz = lattice.size[2];
  std::vector<std::size_t> border;
  std::vector<Vec3d> places;  // in the wider map's lattice
  const auto add = [&](int i, int j, int k) {
    border.push_back(static_cast<std::size_t>(i) +
                     static_cast<std::size_t>(nx) *
                         (static_cast<std::size_t>(j) + static_cast<std::size_t>(ny) * static_cast<std::size_t>(k)));
    const Vec3d at = lattice.origin +
                     lattice.step[0].x * Vec3d{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
    Vec3d place;
    for (int axis = 0; axis < 3; ++axis) {
      const double* const row = around.to_index + std::ptrdiff_t{4} * axis;
      place[axis] = row[0] * at.x + row[1] * at.y + row[2] * at.z + row[3];
    }
    places.push_back(place);
  };
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const bool whole_row = j == 0 || k == 0 || j == ny - 1 || k == nz - 1;
      for (int i = 0; i < nx; i += whole_row ? 1 : nx - 1) add(i, j, k);
    }
  }
  const Buffer<std::size_t> points = to_device(border);
  const Buffer<float> values = to_device(values_at(around, places));
  const std::size_t* const point = raw(points);
  const float* const from = raw(values);
  float* const to = raw(phi);
  for_each_index(points.size(), [=] ESPDIFF_HD(std::size_t n) { to[point[n]] = from[n]; });
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

/// Whether a potential of these charges is worth starting from: farther apart, its residual would be above that of
/// zero.
bool is_near(const MapGrid& start, const std::vector<Vec3d>& positions) {
  constexpr double kFarthest_A = 0.2;
  if (start.origin == nullptr || start.origin->positions.size() != positions.size()) return false;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (norm(positions[i] - start.origin->positions[i]) > kFarthest_A) return false;
  }
  return true;
}

/// Inputs of a solution, on any grid.
struct Problem {
  const std::vector<PbAtom>& atoms;
  const PoissonBoltzmannOptions& options;
  PbConstants constants;
  const Progress& progress;
  std::shared_ptr<const SoluteShape>* shape;  ///< for all grids
};

/// Parts of the whole between which a grid's solution reports progress.
struct Stretch {
  double first, last;
  double at(double part) const { return first + (last - first) * part; }
};

/// Solves for phi, whose border is set, and fills the report.
void solve(const Problem& problem, const CubicLattice& lattice, const Stretch& stretch, Buffer<float>& phi,
           PoissonBoltzmannReport& report, std::shared_ptr<const PackedOperator>* kept = nullptr) {
  const PoissonBoltzmannOptions& options = problem.options;
  GridOperator on_grid;
  fill_pb_operator(problem.atoms, lattice, problem.constants, options, on_grid, problem.shape);
  if (stretch.last == 1) problem.shape->reset();  // no grid follows
  problem.progress.report("potential", stretch.at(0.1));
  const SortedCharges<double> charges = charges_on_grid(problem.atoms, lattice, problem.constants.coulomb);
  const RightHandSide b = [&](Buffer<float>& values) { spread_rounded(charges, raw(values)); };
  SolverOptions solver;
  // The error at the surface is then about three times the residual.
  solver.tolerance = options.keep_operator ? std::min(options.tolerance, 3 * kResidualForReadings) : options.tolerance;
  solver.max_cycles = options.max_cycles;
  const auto set_norm = [&](SolverWork& work) {
    b(work.r);
    solver.norm = std::sqrt(dot_product(work.r, work.r));
  };
  const auto step = [&](double error) {
    const double part = std::log(error) / std::log(solver.tolerance);
    problem.progress.report("potential", stretch.at(0.1 + 0.9 * std::min(1.0, std::max(0.0, part))));
  };
  SolverReport solved;
  if (options.nonlinear && options.ionic_strength > 0) {
    SolverWork work(lattice.n_points());
    set_norm(work);
    const Buffer<float> k = on_grid.diagonal;
    const NewtonReport newton_report =
        newton(on_grid, k, Buffer<float>(work.r), solver, options.max_newton_steps, work, phi, step);
    solved = newton_report.solver;
    report.newton_steps = newton_report.steps;
  } else {
    SurfaceError surface(on_grid);
    const auto packed = PackedOperator::pack(on_grid, usual_coefficients(lattice, problem.constants, options));
    if (kept != nullptr) *kept = packed;
    add_faces_to_diagonal(on_grid);
    Multigrid multigrid(on_grid);
    report.levels = multigrid.n_levels();
    SolverWork work(lattice.n_points(), hold_packed(on_grid, packed));
    set_norm(work);
    solved = conjugate_gradients(on_grid, multigrid, b, solver, work, phi, step, &surface);
  }
  report.surface_error = solved.surface_error;
  report.relative_residual = solved.relative_residual;
  report.start_residual = solved.start_residual;
  report.cycles = solved.cycles;
  require_converged(options, solved, report.newton_steps);
}

constexpr Stretch kOfBorder{0.0, 0.25}, kOfMap{0.25, 1.0};

void set_border(const Problem& problem, const Lattice& on_lattice, const CubicLattice& lattice, Buffer<float>& phi) {
  const DebyeHueckel law = border_law(problem.constants, problem.options);
  if (problem.options.far_boundary == FarBoundary::kDebyeHueckel) {
    set_debye_hueckel_border(problem.atoms, lattice, law, phi);
    return;
  }
  MapGrid around;
  around.lattice = wider_lattice(on_lattice, problem.atoms);
  require_pb_memory(around.lattice, on_lattice.step[0].x, problem.options);  // of few atoms it is the larger grid
  set_index_transform(around.lattice, {}, "the wider grid", around.to_index);
  const CubicLattice wide = cubic_lattice(around.lattice);
  around.values.assign(wide.n_points(), 0.0F);
  set_debye_hueckel_border(problem.atoms, wide, law, around.values);
  PoissonBoltzmannReport ignored;
  solve(problem, wide, kOfBorder, around.values, ignored);
  set_border_from(around, on_lattice, phi);
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
  std::shared_ptr<const SoluteShape> shape;
  const Problem problem{atoms, options, pb_constants(options), progress, &shape};
  auto map = std::make_shared<MapGrid>();
  map->lattice = on_lattice;
  map->unit = PotentialUnit::kKtPerE;
  set_index_transform(map->lattice, to_map, "the potential", map->to_index);
  map->values.assign(lattice.n_points(), 0.0F);
  progress.report("potential", 0.0);
  if (start != nullptr && is_near(*start, positions)) start_from(*start, on_lattice, map->values);
  set_border(problem, on_lattice, lattice, map->values);
  progress.report("potential", kOfMap.first);
  PoissonBoltzmannReport told;
  told.bytes_per_point = pb_bytes_per_point(options);
  told.debye_length_A = 1 / problem.constants.kappa;
  for (const PbAtom& atom : atoms) {
    told.net_charge += static_cast<double>(atom.charge);
    told.n_charges += atom.charge != 0 ? 1 : 0;
  }
  auto origin = std::make_shared<MapOrigin>();
  const bool keeps = options.keep_operator && !(options.nonlinear && options.ionic_strength > 0);
  solve(problem, lattice, kOfMap, map->values, told, keeps ? &origin->pb_operator : nullptr);
  origin->method = PotentialMethod::kPoissonBoltzmann;
  origin->positions = positions;
  origin->to_map = to_map;
  origin->radii = radii;
  origin->charges = charges;
  origin->pb = options;
  map->origin = std::move(origin);
  if (report != nullptr) *report = told;
  progress.report("potential", 1.0);
  return map;
}

}  // namespace espdiff::ESPDIFF_BACKEND
