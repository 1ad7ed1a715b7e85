// poisson_boltzmann.cu: from atoms to the potential: sets up the equation on the grid and solves it.
#include "cuda/potential/pb/poisson_boltzmann.h"

#include <algorithm>
#include <cmath>
#include <functional>
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

/// Trilinear samples of a map of twice the spacing.
struct WiderSamples {
  const float* corner;     ///< of the cell that holds the grid's first point
  std::size_t row, plane;  ///< of the wider map
  float first[3];          ///< place of the grid's first point in that cell, in cells

  ESPDIFF_INLINE float at(int i, int j, int k) const {
    int cell[3];
    float part[3];
    const int index[3] = {i, j, k};
    for (int axis = 0; axis < 3; ++axis) {
      const float place = first[axis] + ((index[axis] & 1) != 0 ? 0.5F : 0.0F);
      const int next = place >= 1.0F ? 1 : 0;
      cell[axis] = index[axis] / 2 + next;
      part[axis] = place - static_cast<float>(next);
    }
    const float* const low = corner + (static_cast<std::size_t>(cell[0]) + row * static_cast<std::size_t>(cell[1]) +
                                       plane * static_cast<std::size_t>(cell[2]));
    const float below = between(part[1], along_x(low, part[0]), along_x(low + row, part[0])),
                above = between(part[1], along_x(low + plane, part[0]), along_x(low + plane + row, part[0]));
    return between(part[2], below, above);
  }
  static ESPDIFF_INLINE float between(float part, float a, float b) { return a + part * (b - a); }
  static ESPDIFF_INLINE float along_x(const float* line, float part) { return between(part, line[0], line[1]); }
};

#if !defined(__CUDACC__)
ESPDIFF_MULTIVERSION void fill_from_wider(const WiderSamples& given, int nx, int j, int k, float* out) {
  const WiderSamples wider = given;
#pragma GCC ivdep
  for (int i = 0; i < nx; ++i) out[i] = wider.at(i, j, k);
}
#endif

enum class Points { kAll, kBorder };

/// Sets points of phi to samples of a wider map. As a start its error at the surface is a few per cent, although that
/// next to charges makes its residual larger than that of zero: up to three cycles less.
void set_from_wider(const MapGrid& around, const Lattice& lattice, Points points, Buffer<float>& phi) {
  WiderSamples wider{raw(around.values), static_cast<std::size_t>(around.lattice.size[0]), 0, {}};
  wider.plane = wider.row * static_cast<std::size_t>(around.lattice.size[1]);
  const std::size_t strides[3] = {1, wider.row, wider.plane};
  for (int axis = 0; axis < 3; ++axis) {
    const double place = (lattice.origin[axis] - around.lattice.origin[axis]) / around.lattice.step[0].x,
                 cell = std::floor(place);
    wider.corner += static_cast<std::size_t>(cell) * strides[axis];
    wider.first[axis] = static_cast<float>(place - cell);
  }
  const int nx = lattice.size[0], ny = lattice.size[1], nz = lattice.size[2];
  const std::size_t row = static_cast<std::size_t>(nx),
                    n_rows = static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz);
  const bool is_all = points == Points::kAll;
  float* const out = raw(phi);
#if defined(__CUDACC__)
  for_each_index(row * n_rows, [=] ESPDIFF_HD(std::size_t p) {
    const int i = static_cast<int>(p % row), j = static_cast<int>(p / row % static_cast<std::size_t>(ny)),
              k = static_cast<int>(p / row / static_cast<std::size_t>(ny));
    const bool is_inner = i > 0 && j > 0 && k > 0 && i < nx - 1 && j < ny - 1 && k < nz - 1;
    if (is_all || !is_inner) out[p] = wider.at(i, j, k);
  });
#else
  for_each_index(n_rows, [=](std::size_t r) {
    const int j = static_cast<int>(r % static_cast<std::size_t>(ny)),
              k = static_cast<int>(r / static_cast<std::size_t>(ny));
    float* const of_row = out + row * r;
    if (is_all || j == 0 || k == 0 || j == ny - 1 || k == nz - 1) return fill_from_wider(wider, nx, j, k, of_row);
    of_row[0] = wider.at(0, j, k);
    of_row[nx - 1] = wider.at(nx - 1, j, k);
  });
#endif
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

/// Sets the border of phi, which is zero before, and its other points to what the solution starts from. @returns
/// whether that is a solution of a coarser grid
using SetStart = std::function<bool(Buffer<float>& phi)>;

/// Solves for phi, and fills the report.
void solve(const Problem& problem, const CubicLattice& lattice, const Stretch& stretch, const SetStart& set_start,
           Buffer<float>& phi, PoissonBoltzmannReport& report, std::shared_ptr<const PackedOperator>* kept = nullptr) {
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
    phi.assign(lattice.n_points(), 0.0F);
    set_start(phi);
    SolverWork work(lattice.n_points());
    set_norm(work);
    const Buffer<float> k = on_grid.diagonal;
    const NewtonReport newton_report =
        newton(on_grid, k, Buffer<float>(work.r), solver, options.max_newton_steps, work, phi, step);
    solved = newton_report.solver;
    report.newton_steps = newton_report.steps;
  } else {
    SurfaceError surface(on_grid);
    // What the border lacks arrives at the surface as a tenth, or less.
    constexpr double kShareOfBorder = 0.1;
    if (stretch.last < 1 && surface.is_known()) solver.tolerance /= kShareOfBorder;
    const auto packed = PackedOperator::pack(on_grid, usual_coefficients(lattice, problem.constants, options));
    if (kept != nullptr) *kept = packed;
    add_faces_to_diagonal(on_grid, packed);
    Multigrid multigrid(on_grid);
    report.levels = multigrid.n_levels();
    phi.assign(lattice.n_points(), 0.0F);  // only now, since the coefficients' arrays are not needed any more
    solver.keeps_start = set_start(phi);
    SolverWork work(lattice.n_points(), spare_arrays(on_grid));
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

/// The potential on a wider grid.
MapGrid wider_potential(const Problem& problem, const Lattice& on_lattice) {
  MapGrid around;
  around.lattice = wider_lattice(on_lattice, problem.atoms);
  require_pb_memory(around.lattice, on_lattice.step[0].x, problem.options);  // of few atoms it is the larger grid
  set_index_transform(around.lattice, {}, "the wider grid", around.to_index);
  const CubicLattice wide = cubic_lattice(around.lattice);
  PoissonBoltzmannReport ignored;
  const auto set_border = [&](Buffer<float>& phi) {
    set_debye_hueckel_border(problem.atoms, wide, border_law(problem.constants, problem.options), phi);
    return false;
  };
  solve(problem, wide, kOfBorder, set_border, around.values, ignored);
  return around;
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
  progress.report("potential", 0.0);
  const bool has_wider = options.far_boundary != FarBoundary::kDebyeHueckel;
  MapGrid around;
  if (has_wider) around = wider_potential(problem, on_lattice);
  const auto set_start = [&](Buffer<float>& phi) {
    const bool has_earlier = start != nullptr && is_near(*start, positions);
    if (has_earlier) start_from(*start, on_lattice, phi);
    if (!has_wider) {
      set_debye_hueckel_border(atoms, lattice, border_law(problem.constants, options), phi);
      return false;
    }
    set_from_wider(around, on_lattice, has_earlier ? Points::kBorder : Points::kAll, phi);
    around.values = Buffer<float>();
    return !has_earlier;
  };
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
  solve(problem, lattice, kOfMap, set_start, map->values, told, keeps ? &origin->pb_operator : nullptr);
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
