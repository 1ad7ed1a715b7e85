// pb_contributions.cu: the transpose of the Poisson-Boltzmann potential: one solution a reading gives what each charge
// adds to it.
//
// On the inner points i and the border b the potential is phi_i = A_ii^-1 (S q - A_ib phi_b), phi_b = B q: charges
// spread by splines, Debye-Hueckel values on the border. A reading is g . phi. Since A_ii is symmetric,
//
//     y = A_ii^-1 g_i,    contribution of charge j = q_j (S^t y + B^t (g_b - A_bi y))_j
//
// and the contributions add up to the reading. With a border from a wider grid, B^t is that grid's own transpose.
#include <cmath>

#include "base/error.h"
#include "cuda/potential/conjugate_gradients.h"
#include "cuda/potential/contributions.h"
#include "cuda/potential/debye_hueckel.h"
#include "cuda/potential/map_origin.h"
#include "cuda/potential/pb_checks.h"
#include "cuda/potential/pb_problem.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The transposes on one grid, for several readings. All is public: nvcc takes no device lambdas in private members.
struct TransposedProblem {
  TransposedProblem(const MapOrigin& origin, const std::vector<ProbeCharge>& probes, const Lattice& on_lattice,
                    const CubicLattice& lattice)
      : origin_(origin),
        probes_(probes),
        constants_(pb_constants(origin.pb)),
        on_lattice_(on_lattice),
        lattice_(lattice),
        grid_size_{lattice.size[0], lattice.size[1], lattice.size[2]},
        work_(lattice.n_points()),
        y_(lattice.n_points(), 0.0F),
        g_(lattice.n_points(), 0.0F) {
    for (std::size_t i = 0; i < origin.positions.size(); ++i)
      atoms_.push_back({origin.positions[i], origin.radii[i], origin.charges[i]});
    for (const ProbeCharge& probe : probes) atoms_.push_back({probe.position, probe.radius, probe.charge});
    fill_pb_operator(sorted_atoms(origin.positions, origin.radii, origin.charges), lattice_, constants_, origin.pb,
                     on_grid_);
    add_faces_to_diagonal(on_grid_);
    multigrid_ = std::make_unique<Multigrid>(on_grid_);
  }

  /// [atom, then probe] contribution of a unit charge. @param reading g, on this grid's points
  std::vector<double> unit_contributions(const SparseValues& reading, const std::function<void(double)>& step) {
    std::vector<double> sums(atoms_.size(), 0.0);
    if (reading.point.empty()) return sums;
    SparseValues inner, border;
    for (std::size_t n = 0; n < reading.point.size(); ++n) {
      SparseValues& part = is_border(reading.point[n]) ? border : inner;
      part.point.push_back(reading.point[n]);
      part.value.push_back(reading.value[n]);
    }
    solve(inner, step);
    add_charges(sums);
    set_border_gradient(border);
    const std::vector<double> far =
        origin_.pb.far_boundary == FarBoundary::kDebyeHueckel
            ? debye_hueckel_transposed(atoms_, lattice_, border_law(constants_, origin_.pb), g_)
            : of_wider_grid(step);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += far[i];
    return sums;
  }

  bool is_border(std::size_t point) const {
    const std::size_t at[3] = {point % grid_size_.row(), point % grid_size_.plane() / grid_size_.row(),
                               point / grid_size_.plane()};
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] == 0 || at[axis] + 1 == static_cast<std::size_t>(lattice_.size[axis])) return true;
    }
    return false;
  }

  /// Adds values to g_.
  void add_to_g(const SparseValues& values) {
    const Buffer<std::size_t> points = to_device(values.point);
    const Buffer<float> added = to_device(values.value);
    const std::size_t* const point = raw(points);
    const float* const value = raw(added);
    float* const g = raw(g_);
    for_each_index(points.size(), [=] ESPDIFF_HD(std::size_t n) { g[point[n]] += value[n]; });
  }

  /// y_ = A_ii^-1 g.
  void solve(const SparseValues& inner, const std::function<void(double)>& step) {
    g_.assign(g_.size(), 0.0F);
    y_.assign(y_.size(), 0.0F);
    add_to_g(inner);
    SolverOptions solver;
    solver.tolerance = origin_.pb.tolerance;
    solver.max_cycles = origin_.pb.max_cycles;
    solver.norm = std::sqrt(dot_product(g_, g_));
    if (solver.norm == 0) return;
    const SolverReport solved = conjugate_gradients(on_grid_, *multigrid_, g_, solver, work_, y_, step);
    require_converged(origin_.pb, solved, 0);
  }

  /// S^t y: the spline of each charge over y.
  void add_charges(std::vector<double>& sums) const {
    MapGrid solution;
    solution.lattice = on_lattice_;
    solution.values = y_;
    solution.periodic = true;  // splines are of periodic maps; charges lie far from the border
    solution.spline_order = 4;
    std::vector<Vec3d> places;
    const double h = static_cast<double>(lattice_.spacing);
    for (const PbAtom& atom : atoms_) {
      Vec3d u;
      for (int axis = 0; axis < 3; ++axis)
        u[axis] = (atom.position[axis] - static_cast<double>(lattice_.origin[axis])) / h;
      places.push_back(u);
    }
    const std::vector<float> found = values_at(solution, places);
    const double scale = charge_scale(lattice_, constants_.coulomb);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += scale * static_cast<double>(found[i]);
  }

  /// g_ = the reading's gradient on the border: g_b - A_bi y.
  void set_border_gradient(const SparseValues& border) {
    const GridSize size = grid_size_;
    const float* const ex = raw(on_grid_.ex);
    const float* const ey = raw(on_grid_.ey);
    const float* const ez = raw(on_grid_.ez);
    const float* const y = raw(y_);
    float* const g = raw(g_);
    for_each_index(size.points(), [=] ESPDIFF_HD(std::size_t p) {
      const int n[3] = {size.nx, size.ny, size.nz};
      const std::size_t step[3] = {1, size.row(), size.plane()};
      const int at[3] = {static_cast<int>(p % size.row()), static_cast<int>(p % size.plane() / size.row()),
                         static_cast<int>(p / size.plane())};
      const float* const eps[3] = {ex, ey, ez};
      int n_faces = 0;
      float value = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (at[axis] == 0) {
          value = eps[axis][p] * y[p + step[axis]];
          ++n_faces;
        } else if (at[axis] == n[axis] - 1) {
          value = eps[axis][p - step[axis]] * y[p - step[axis]];
          ++n_faces;
        }
      }
      g[p] = n_faces == 1 ? value : 0.0F;  // points of two faces have no inner neighbour
    });
    add_to_g(border);
  }

  /// The transpose of the border's samples of a wider grid, and of that grid's potential.
  std::vector<double> of_wider_grid(const std::function<void(double)>& step) {
    MapGrid around;
    around.lattice = twice_as_wide(on_lattice_);
    set_index_transform(around.lattice, {}, "the coarse grid", around.to_index);
    const std::vector<float> gradient = to_host(g_);
    WeightedPlaces border;
    for (std::size_t p = 0; p < gradient.size(); ++p) {
      if (gradient[p] == 0 || !is_border(p)) continue;
      const Vec3d at = on_lattice_.origin + static_cast<double>(p % grid_size_.row()) * on_lattice_.step[0] +
                       static_cast<double>(p % grid_size_.plane() / grid_size_.row()) * on_lattice_.step[1] +
                       static_cast<double>(p / grid_size_.plane()) * on_lattice_.step[2];
      Vec3d place;
      for (int axis = 0; axis < 3; ++axis) {
        const double* const row = around.to_index + std::ptrdiff_t{4} * axis;
        place[axis] = row[0] * at.x + row[1] * at.y + row[2] * at.z + row[3];
      }
      border.place.push_back(place);
      border.weight.push_back(static_cast<double>(gradient[p]));
    }
    MapOrigin with_sum = origin_;
    with_sum.pb.far_boundary = FarBoundary::kDebyeHueckel;
    TransposedProblem wide(with_sum, probes_, around.lattice, twice_as_wide(lattice_, around.lattice));
    return wide.unit_contributions(spread_linearly(around, border), step);
  }

 private:
  const MapOrigin& origin_;
  const std::vector<ProbeCharge>& probes_;
  PbConstants constants_;
  Lattice on_lattice_;
  CubicLattice lattice_;
  GridSize grid_size_;
  std::vector<PbAtom> atoms_;  ///< in the order of the input, then the probes
  GridOperator on_grid_;
  std::unique_ptr<Multigrid> multigrid_;
  SolverWork work_;
  Buffer<float> y_, g_;
};

void require_probes_inside(const MapOrigin& origin, const CubicLattice& lattice,
                           const std::vector<ProbeCharge>& probes) {
  constexpr double kSplineReach = 2;  // in grid spacings
  for (const ProbeCharge& probe : probes) {
    for (int axis = 0; axis < 3; ++axis) {
      const double u =
          (probe.position[axis] - static_cast<double>(lattice.origin[axis])) / static_cast<double>(lattice.spacing);
      if (u >= kSplineReach && u <= static_cast<double>(lattice.size[axis] - 1) - kSplineReach) continue;
      throw InputError("a charge is asked about outside the potential's grid of " +
                       std::to_string(origin.positions.size()) + " charges; give the grid a wider padding");
    }
  }
}

}  // namespace

std::vector<std::vector<double>> pb_contributions(const MapGrid& map, const std::vector<WeightedPlaces>& readings,
                                                  const std::vector<ProbeCharge>& probes, const Progress& progress) {
  const MapOrigin& origin = *map.origin;
  if (origin.pb.nonlinear && origin.pb.ionic_strength > 0)
    throw InputError(
        "the nonlinear Poisson-Boltzmann equation has no causes: its potential is not a sum over charges; take the "
        "linearized equation");
  const CubicLattice lattice = checked_pb_lattice(map.lattice, origin.positions, origin.pb);
  require_probes_inside(origin, lattice, probes);
  progress.report("causes", 0.0);
  TransposedProblem problem(origin, probes, map.lattice, lattice);
  std::vector<std::vector<double>> result;
  for (const WeightedPlaces& reading : readings) {
    const auto step = [&](double residual) {
      const double part = std::log(residual) / std::log(origin.pb.tolerance);
      progress.report("causes", (static_cast<double>(result.size()) + std::min(1.0, std::max(0.0, part))) /
                                    static_cast<double>(readings.size()));
    };
    std::vector<double> of_atom = problem.unit_contributions(spread_linearly(map, reading), step);
    scale_by_charges(origin, probes, of_atom);
    result.push_back(std::move(of_atom));
  }
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
