// pb_contributions.cu: the transpose of the Poisson-Boltzmann potential: one solution a reading gives what each charge
// adds to it.
//
// On the inner points i and the border b the potential is phi_i = A_ii^-1 (S q - A_ib phi_b), phi_b = B q: charges
// spread by splines, Debye-Hueckel values on the border. A reading is g . phi. Since A_ii is symmetric,
//
//     y = A_ii^-1 g_i,    contribution of charge j = q_j (S^t y + B^t (g_b - A_bi y))_j
//
// and the contributions add up to the reading. With a border from a wider grid, B^t is that grid's own transpose.
#include "cuda/potential/pb/pb_contributions.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.h"
#include "cuda/potential/debye_hueckel.h"
#include "cuda/potential/map_origin.h"
#include "cuda/potential/pb/conjugate_gradients.h"
#include "cuda/potential/pb/pb_checks.h"
#include "cuda/potential/pb/pb_problem.h"
#include "cuda/surface/density/bspline.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

using AfterCycle = std::function<void(double)>;

/// A residual r of a reading's solution changes the sum of its contributions by r . phi. r oscillates from point to
/// point, where phi is smooth: at a residual of 3e-6 the sum changes by at most 7e-7 kT/e where potentials are
/// about 1 kT/e, that is by 5e-6 of a reading of which a tenth is left. Where less is left, the tolerance is smaller in
/// proportion; below a tenth of the potential's, the potential's own residual is the larger one.
double reading_tolerance(const PoissonBoltzmannOptions& options, double share_left) {
  constexpr double kLargest = 1e-4, kLargestFactor = 3, kLeastFactor = 0.1, kFactorOfShare = 25;
  const double factor = std::max(kLeastFactor, std::min(kLargestFactor, kFactorOfShare * share_left));
  const double residual = std::min(options.tolerance, kResidualForReadings);
  return std::min(factor * residual, std::max(residual, kLargest));
}

/// The transposes on one grid, for several readings. All is public: nvcc takes no device lambdas in private members.
struct TransposedProblem {
  /// @param kept the grid's coefficients; null makes them
  TransposedProblem(const MapOrigin& origin, const std::vector<PbAtom>& atoms, const Lattice& on_lattice,
                    const CubicLattice& lattice, const std::shared_ptr<const PackedOperator>& kept)
      : origin_(origin),
        atoms_(atoms),
        constants_(pb_constants(origin.pb)),
        own_(on_lattice),
        lattice_(lattice),
        grid_size_{lattice.size[0], lattice.size[1], lattice.size[2]} {
    // First, since it needs memory of its own for a while.
    std::shared_ptr<const PackedOperator> packed = kept;
    if (packed != nullptr) {
      packed->unpack(on_grid_);
    } else {
      fill_pb_operator(sorted_atoms(origin.positions, origin.radii, origin.charges), lattice_, constants_, origin.pb,
                       on_grid_);
      packed = PackedOperator::pack(on_grid_, usual_coefficients(lattice_, constants_, origin.pb));
    }
    add_faces_to_diagonal(on_grid_, packed);
    multigrid_ = std::make_unique<Multigrid>(on_grid_);
    find_border_faces();
    work_ = std::make_unique<SolverWork>(lattice.n_points(), spare_arrays(on_grid_));
    place_charges();
  }

  /// Adds S^t y to the sums of unit charges, and leaves the gradient on the border.
  /// @param reading g, on this grid's points
  /// @param sums    [charge]
  void add_inner(const SparseValues& reading, double share_left, const AfterCycle& step, std::vector<double>& sums) {
    SparseValues inner, border;
    for (std::size_t n = 0; n < reading.point.size(); ++n) {
      SparseValues& part = is_border(reading.point[n]) ? border : inner;
      part.point.push_back(reading.point[n]);
      part.value.push_back(reading.value[n]);
    }
    at_charges_.assign(place_.size(), 0.0);
    for (BorderFaces& faces : border_faces_) faces.gradient.assign(faces.point.size(), 0.0F);
    solve(inner, reading_tolerance(origin_.pb, share_left), step);
    const std::vector<double> found = to_host(at_charges_);
    const double scale = charge_scale(lattice_, constants_.coulomb);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += scale * found[i];
    set_border_gradient(border);
  }

  /// Adds B^t of the gradient, of Debye-Hueckel values on the border.
  void add_border(std::vector<double>& sums) {
    const std::vector<double> far =
        debye_hueckel_transposed(atoms_, lattice_, border_law(constants_, origin_.pb), work_->r);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += far[i];
  }

  bool is_border(std::size_t point) const {
    const std::size_t at[3] = {point % grid_size_.row(), point % grid_size_.plane() / grid_size_.row(),
                               point / grid_size_.plane()};
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] == 0 || at[axis] + 1 == static_cast<std::size_t>(lattice_.size[axis])) return true;
    }
    return false;
  }

  static void add_to(Buffer<float>& g, const SparseValues& values) {
    const Buffer<std::size_t> points = to_device(values.point);
    const Buffer<float> added = to_device(values.value);
    const std::size_t* const point = raw(points);
    const float* const value = raw(added);
    float* const to = raw(g);
    for_each_index(points.size(), [=] ESPDIFF_HD(std::size_t n) { to[point[n]] += value[n]; });
  }

  /// Adds up S^t y and A_bi y of y = A_ii^-1 g.
  void solve(const SparseValues& inner, double tolerance, const AfterCycle& step) {
    SolverOptions solver;
    solver.tolerance = tolerance;
    solver.max_cycles = origin_.pb.max_cycles;
    solver.norm = 0;
    for (const float value : inner.value) solver.norm += static_cast<double>(value) * static_cast<double>(value);
    solver.norm = std::sqrt(solver.norm);
    if (solver.norm == 0) return;
    work_->r.assign(work_->r.size(), 0.0F);
    add_to(work_->r, inner);
    const TakeDirection take = [&](double alpha, const Buffer<float>& p) {
      add_at_charges(alpha, p);
      add_at_border(static_cast<float>(alpha), p);
    };
    require_converged(origin_.pb, conjugate_gradients(*multigrid_, solver, *work_, take, step), 0);
  }

  void place_charges() {
    std::vector<Vec3d> places;
    const double h = static_cast<double>(lattice_.spacing);
    for (const PbAtom& atom : atoms_) {
      Vec3d u;
      for (int axis = 0; axis < 3; ++axis)
        u[axis] = (atom.position[axis] - static_cast<double>(lattice_.origin[axis])) / h;
      places.push_back(u);
    }
    place_ = to_device(places);
  }

  /// The spline of each charge over alpha p, in double precision, since many charges' parts cancel.
  void add_at_charges(double alpha, const Buffer<float>& p) {
    const Vec3d* const at = raw(place_);
    const float* const from = raw(p);
    double* const sums = raw(at_charges_);
    const GridSize size = grid_size_;
    for_each_index(place_.size(), [=] ESPDIFF_HD(std::size_t i) {
      constexpr int kCubic = 4;
      const int n[3] = {size.nx, size.ny, size.nz};
      int base[3];
      double weight[3][kCubic];
      for (int axis = 0; axis < 3; ++axis) {
        const SplinePlace place = spline_place(at[i][axis], kCubic, n[axis]);
        base[axis] = place.base;
        spline_weights<kCubic>(place.part, weight[axis]);
      }
      double sum = 0;
      for (int c = 0; c < kCubic; ++c) {
        for (int b = 0; b < kCubic; ++b) {
          const std::size_t row = size.index(base[0], base[1] + b, base[2] + c);
          double along = 0;
          for (std::size_t a = 0; a < kCubic; ++a) along += weight[0][a] * static_cast<double>(from[row + a]);
          sum += weight[2][c] * weight[1][b] * along;
        }
      }
      sums[i] += alpha * sum;
    });
  }

  void add_at_border(float alpha, const Buffer<float>& p) {
    const float* const from = raw(p);
    for (BorderFaces& faces : border_faces_) {
      const std::size_t* const point = raw(faces.point);
      const float* const dielectric = raw(faces.dielectric);
      float* const gradient = raw(faces.gradient);
      const std::size_t step = faces.step;
      const bool is_first = faces.is_first;
      for_each_index(faces.point.size(), [=] ESPDIFF_HD(std::size_t n) {
        gradient[n] += alpha * dielectric[n] * from[is_first ? point[n] + step : point[n] - step];
      });
    }
  }

  /// The faces between a point of the border and an inner point. Border points of two faces of the grid have none.
  void find_border_faces() {
    const std::size_t step[3] = {1, grid_size_.row(), grid_size_.plane()};
    const Buffer<float>* const faces[3] = {&on_grid_.ex, &on_grid_.ey, &on_grid_.ez};
    for (int axis = 0; axis < 3; ++axis) {
      const int side = (axis + 1) % 3, up = (axis + 2) % 3;
      std::vector<std::size_t> first, last;  // points of the two borders
      for (int v = 1; v < lattice_.size[up] - 1; ++v) {
        for (int u = 1; u < lattice_.size[side] - 1; ++u) {
          first.push_back(static_cast<std::size_t>(u) * step[side] + static_cast<std::size_t>(v) * step[up]);
          last.push_back(first.back() + static_cast<std::size_t>(lattice_.size[axis] - 1) * step[axis]);
        }
      }
      const auto keep = [&](const std::vector<std::size_t>& border, bool is_first) {
        BorderFaces kept{to_device(border), Buffer<float>(border.size()), {}, step[axis], is_first};
        const std::size_t* const point = raw(kept.point);
        const float* const from = raw(*faces[axis]);
        float* const to = raw(kept.dielectric);
        const std::size_t back = is_first ? 0 : step[axis];
        for_each_index(border.size(), [=] ESPDIFF_HD(std::size_t n) { to[n] = from[point[n] - back]; });
        border_faces_.push_back(std::move(kept));
      };
      keep(first, true);
      keep(last, false);
    }
  }

  /// The solver's r, on the border, = the reading's gradient there, g_b - A_bi y.
  void set_border_gradient(const SparseValues& border) {
    float* const g = raw(work_->r);
    work_->r.assign(work_->r.size(), 0.0F);
    for (const BorderFaces& faces : border_faces_) {
      const std::size_t* const point = raw(faces.point);
      const float* const gradient = raw(faces.gradient);
      for_each_index(faces.point.size(), [=] ESPDIFF_HD(std::size_t n) { g[point[n]] = gradient[n]; });
    }
    add_to(work_->r, border);
  }

  std::vector<float> gradient_at(const std::vector<std::size_t>& points) const {
    const Buffer<std::size_t> on_device = to_device(points);
    Buffer<float> values(points.size());
    const std::size_t* const point = raw(on_device);
    const float* const g = raw(work_->r);
    float* const value = raw(values);
    for_each_index(points.size(), [=] ESPDIFF_HD(std::size_t n) { value[n] = g[point[n]]; });
    return to_host(values);
  }

  /// The transpose of samples on the border of a grid that lies within `around`: the gradient as weights of places in
  /// it.
  WeightedPlaces border_in(const MapGrid& around) const {
    std::vector<std::size_t> points;
    for (std::size_t p = 0; p < grid_size_.points(); ++p) {
      if (is_border(p)) points.push_back(p);
    }
    const std::vector<float> gradient = gradient_at(points);
    const Lattice& own = own_;
    WeightedPlaces border;
    for (std::size_t n = 0; n < points.size(); ++n) {
      const std::size_t p = points[n];
      if (gradient[n] == 0) continue;
      const Vec3d at = own.origin + static_cast<double>(p % grid_size_.row()) * own.step[0] +
                       static_cast<double>(p % grid_size_.plane() / grid_size_.row()) * own.step[1] +
                       static_cast<double>(p / grid_size_.plane()) * own.step[2];
      Vec3d place;
      for (int axis = 0; axis < 3; ++axis) {
        const double* const row = around.to_index + std::ptrdiff_t{4} * axis;
        place[axis] = row[0] * at.x + row[1] * at.y + row[2] * at.z + row[3];
      }
      border.place.push_back(place);
      border.weight.push_back(static_cast<double>(gradient[n]));
    }
    return border;
  }

 private:
  const MapOrigin& origin_;
  const std::vector<PbAtom>& atoms_;  ///< that are charged, in the order of the input; then the probes
  PbConstants constants_;
  Lattice own_;
  CubicLattice lattice_;
  GridSize grid_size_;
  GridOperator on_grid_;
  std::unique_ptr<Multigrid> multigrid_;
  std::unique_ptr<SolverWork> work_;
  Buffer<Vec3d> place_;        ///< [charge] in grid spacings
  Buffer<double> at_charges_;  ///< [charge] S^t y, without its scale
  /// Of one side of the grid.
  struct BorderFaces {
    Buffer<std::size_t> point;
    Buffer<float> dielectric;
    Buffer<float> gradient;  ///< the dielectric times y at the inner point
    std::size_t step;        ///< to the inner point
    bool is_first;           ///< whether that is the next point along the axis, not the one before
  };
  std::vector<BorderFaces> border_faces_;
};

std::vector<PbAtom> atoms_and_probes(const MapOrigin& origin, const std::vector<ProbeCharge>& probes) {
  std::vector<PbAtom> all;
  for (std::size_t i = 0; i < origin.positions.size(); ++i)
    all.push_back({origin.positions[i], origin.radii[i], origin.charges[i]});
  for (const ProbeCharge& probe : probes) all.push_back({probe.position, probe.radius, probe.charge});
  return all;
}

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

std::vector<std::vector<double>> pb_contributions(const MapGrid& map, const std::vector<PotentialReading>& readings,
                                                  const std::vector<ProbeCharge>& probes, const Progress& progress) {
  const MapOrigin& origin = *map.origin;
  if (origin.pb.nonlinear && origin.pb.ionic_strength > 0)
    throw InputError(
        "the nonlinear Poisson-Boltzmann equation has no causes: its potential is not a sum over charges; take the "
        "linearized equation");
  const CubicLattice lattice = checked_pb_lattice(map.lattice, origin.positions, origin.pb);
  require_probes_inside(origin, lattice, probes);
  progress.report("causes", 0.0);
  const std::vector<PbAtom> all = atoms_and_probes(origin, probes);
  std::vector<PbAtom> atoms;
  std::copy_if(all.begin(), all.end(), std::back_inserter(atoms), [](const PbAtom& a) { return a.charge != 0; });
  const bool has_wider = origin.pb.far_boundary != FarBoundary::kDebyeHueckel;
  // Readings on the map's own grid first, then on the wider one: only one grid's arrays are there at a time.
  const double n_solutions = static_cast<double>(readings.size()) * (has_wider ? 2 : 1);
  std::vector<std::vector<double>> result(readings.size(), std::vector<double>(atoms.size(), 0.0));
  const auto step_of = [&](std::size_t solution) {
    return [&, solution](double residual) {
      const double tolerance = reading_tolerance(origin.pb, readings[solution % readings.size()].share_left);
      const double part = std::log(residual) / std::log(tolerance);
      progress.report("causes", (static_cast<double>(solution) + std::min(1.0, std::max(0.0, part))) / n_solutions);
    };
  };
  MapGrid around;
  around.lattice = wider_lattice(map.lattice, sorted_atoms(origin.positions, origin.radii, origin.charges));
  set_index_transform(around.lattice, {}, "the coarse grid", around.to_index);
  std::vector<WeightedPlaces> borders;
  {
    TransposedProblem problem(origin, atoms, map.lattice, lattice, origin.pb_operator);
    for (std::size_t r = 0; r < readings.size(); ++r) {
      problem.add_inner(spread_linearly(map, weighted_places(map, readings[r])), readings[r].share_left, step_of(r),
                        result[r]);
      if (has_wider) borders.push_back(problem.border_in(around));
      if (!has_wider) problem.add_border(result[r]);
    }
  }
  if (has_wider) {
    TransposedProblem problem(origin, atoms, around.lattice, cubic_lattice(around.lattice), nullptr);
    for (std::size_t r = 0; r < readings.size(); ++r) {
      problem.add_inner(spread_linearly(around, borders[r]), readings[r].share_left, step_of(readings.size() + r),
                        result[r]);
      problem.add_border(result[r]);
    }
  }
  for (std::vector<double>& of_charge : result) {
    std::vector<double> of_atom(all.size(), 0.0);
    for (std::size_t i = 0, charge = 0; i < all.size(); ++i) {
      if (all[i].charge != 0) of_atom[i] = static_cast<double>(all[i].charge) * of_charge[charge++];
    }
    of_charge = std::move(of_atom);
  }
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
