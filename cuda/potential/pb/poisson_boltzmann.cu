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

/// Trilinear samples of a map of twice the spacing.
struct WiderSamples {
  const float* corner;     ///< of the cell that holds the grid's first point
  std::size_t row, plane;  ///< of the wider map
  float first[3];          ///< place of the grid's first point in that cell, in cells

  ESPDIFF_INLINE float at(int i, int j, int k) const {
    std::size_t cell[3];
    float part[3];
    const int index[3] = {i, j, k};
    for (int axis = 0; axis < 3; ++axis) {
      const float place = first[axis] + 0.5F * static_cast<float>(index[axis]);
      cell[axis] = static_cast<std::size_t>(static_cast<int>(place));
      part[axis] = place - static_cast<float>(static_cast<int>(place));
    }
    const float* const low = corner + cell[0] + row * cell[1] + plane * cell[2];
    const auto along_x = [&](const float* line)
                             ESPDIFF_INLINE_LAMBDA { return line[0] + part[0] * (line[1] - line[0]); };
    const auto along_y = [&](const float* lines) ESPDIFF_INLINE_LAMBDA {
      const float below = along_x(lines);
      return below + part[1] * (along_x(lines + row) - below);
    };
    const float below = along_y(low);
    return below + part[2] * (along_y(low + plane) - below);
  }
};

#if !defined(__CUDACC__)
ESPDIFF_MULTIVERSION void fill_from_wider(const WiderSamples& given, int nx, int j, int k, float* out) {
  const WiderSamples wider = given;
#pragma GCC ivdep
  for (int i = 1; i < nx - 1; ++i) out[i] = wider.at(i, j, k);
}
#endif

/// Sets the inner points of phi to trilinear samples of a wider map of twice the spacing. Its error at the surface is a
/// few per cent, although that next to charges makes its residual larger than that of zero: three cycles less.
void start_from_wider(const MapGrid& around, const Lattice& lattice, Buffer<float>& phi) {
  WiderSamples wider{raw(around.values), static_cast<std::size_t>(around.lattice.size[0]), 0, {}};
  wider.plane = wider.row * static_cast<std::size_t>(around.lattice.size[1]);
  const std::size_t strides[3] = {1, wider.row, wider.plane};
  for (int axis = 0; axis < 3; ++axis) {
    const double place = (lattice.origin[axis] - around.lattice.origin[axis]) / (2 * lattice.step[0].x),
                 cell = std::floor(place);
    wider.corner += static_cast<std::size_t>(cell) * strides[axis];
    wider.first[axis] = static_cast<float>(place - cell);
  }
  const int nx = lattice.size[0], ny = lattice.size[1], nz = lattice.size[2];
  const std::size_t row = static_cast<std::size_t>(nx), plane = row * static_cast<std::size_t>(ny);
  float* const out = raw(phi);
#if defined(__CUDACC__)
  for_each_index(phi.size(), [=] ESPDIFF_HD(std::size_t p) {
    const int i = static_cast<int>(p % row), j = static_cast<int>(p % plane / row), k = static_cast<int>(p / plane);
    if (i > 0 && j > 0 && k > 0 && i < nx - 1 && j < ny - 1 && k < nz - 1) out[p] = wider.at(i, j, k);
  });
#else
  for_each_index(static_cast<std::size_t>(nz - 2), [=](std::size_t inner) {
    for (int j = 1; j < ny - 1; ++j)
      fill_from_wider(wider, nx, j, static_cast<int>(inner) + 1,
                      out + row * static_cast<std::size_t>(j) + plane * (inner + 1));
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
    if (!has_earlier) start_from_wider(around, on_lattice, phi);
    set_border_from(around, on_lattice, phi);
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
