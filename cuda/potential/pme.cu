// pme.cu: smooth particle-mesh Ewald: checks the parameters, spreads the charges, and convolves the grid.
#include "cuda/potential/pme.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "base/progress.h"
#include "base/work.h"
#include "cuda/potential/bulk_zero.h"
#include "cuda/potential/coulomb.h"
#include "cuda/potential/map_origin.h"
#include "cuda/potential/pmepot_places.h"
#include "cuda/potential/spread.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr int kLeastCompatibleSize = 8, kMostSize = 4096;

std::string text_of(const Vec3d& v) {
  return "(" + formatted(v.x) + ", " + formatted(v.y) + ", " + formatted(v.z) + ")";
}
bool all_finite(const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

double checked_volume(const PmeCell& cell) {
  const auto& e = cell.edges;
  if (!all_finite(cell.centre) || !all_finite(e[0]) || !all_finite(e[1]) || !all_finite(e[2]))
    throw InputError("the cell has a centre or an edge that is not finite; give twelve numbers in Angstrom");
  const double volume = dot(e[0], cross(e[1], e[2]));
  // In a flatter cell the reciprocal edges would be rounding noise.
  constexpr double kFlat = 1e-6;
  if (volume > kFlat * norm(e[0]) * norm(e[1]) * norm(e[2])) return volume;
  throw InputError("the cell's edges " + text_of(e[0]) + ", " + text_of(e[1]) + " and " + text_of(e[2]) +
                   " span a volume of " + formatted(volume) +
                   " A^3, which must be positive; give three edges that span space, right-handed");
}

void check_sizes(const PmeOptions& o) {
  const int least = o.compatible ? kLeastCompatibleSize : o.order;
  for (const int n : o.size) {
    if (n >= least && n <= kMostSize) continue;
    throw InputError("a grid of " + std::to_string(o.size[0]) + " x " + std::to_string(o.size[1]) + " x " +
                     std::to_string(o.size[2]) + " points: each edge needs " + std::to_string(least) + " (" +
                     (o.compatible ? std::string("PMEPot's least") : "splines of order " + std::to_string(o.order)) +
                     ") to " + std::to_string(kMostSize) + "; choose another grid or resolution");
  }
  if (o.compatible && o.size[2] % 2 != 0)
    throw InputError("a grid of " + std::to_string(o.size[2]) +
                     " points along the third edge: PMEPot takes even numbers only; choose another, or leave out "
                     "`compatible`");
}

void check_options(const PmeOptions& o) {
  if (o.order < kLeastSplineOrder || o.order > kMostSplineOrder)
    throw InputError("spline order " + std::to_string(o.order) + " is not among 4 to 8; 6 is usual");
  if (o.compatible && o.order != 4)
    throw InputError("spline order " + std::to_string(o.order) + " with `compatible`: PMEPot's is 4; leave one out");
  if (o.compatible && o.smooth_samples)
    throw InputError("`compatible` values are spline coefficients already; smooth samples are for the other mode");
  if (o.compatible && o.part == PmePart::kFull)
    throw InputError("the full sum with `compatible`: PMEPot gives the smooth part only; leave one out");
  if (!(o.ewald_factor > 0) || !std::isfinite(o.ewald_factor))
    throw InputError("Ewald factor " + formatted(o.ewald_factor) + " 1/A is not a positive number; 0.25 is usual");
  check_temperature(o.temperature_K);
  check_sizes(o);
}

/// Memory of a grid point: values, modes, scratch and result.
void check_memory(const PmeOptions& o) {
  const double per_point = o.precision == Precision::kDouble ? 8 + 9 + 4 : 4 + 5 + 4;
  const double n_points = static_cast<double>(o.size[0]) * o.size[1] * o.size[2];
  const double coarser = coarsening_to_fit(n_points, per_point);
  if (coarser <= 1) return;
  throw MemoryError("a grid of " + std::to_string(o.size[0]) + " x " + std::to_string(o.size[1]) + " x " +
                    std::to_string(o.size[2]) + " points " + need_in_words(n_points, per_point) + "; a resolution " +
                    formatted(coarser) + " times as coarse would fit");
}

/// Reciprocal edges, 1/A: the rows of the matrix from positions to fractional coordinates.
std::array<Vec3d, 3> reciprocal_edges(const PmeCell& cell) {
  const auto& e = cell.edges;
  const double inverse = 1.0 / dot(e[0], cross(e[1], e[2]));
  return {inverse * cross(e[1], e[2]), inverse * cross(e[2], e[0]), inverse * cross(e[0], e[1])};
}

/// From positions to grid coordinates, wrapped into the cell.
class GridPlaces {
 public:
  GridPlaces(const PmeCell& cell, const PmeOptions& options)
      : compatible_(options.compatible),
        pmepot_(cell, options.size),
        origin_(lattice_over(cell, options.size).origin),
        size_{options.size[0], options.size[1], options.size[2]} {
    const std::array<Vec3d, 3> reciprocal = reciprocal_edges(cell);
    std::copy(reciprocal.begin(), reciprocal.end(), reciprocal_);
  }

  ESPDIFF_HD Vec3d operator()(const Vec3d& p) const {
    if (compatible_) return pmepot_.coordinates(p);
    Vec3d place;
    for (int axis = 0; axis < 3; ++axis)
      place[axis] = wrapped(static_cast<double>(size_[axis]) * dot(p - origin_, reciprocal_[axis]), size_[axis]);
    return place;
  }

 private:
  bool compatible_;
  PmepotPlaces pmepot_;
  Vec3d origin_, reciprocal_[3];
  int size_[3];
};

/// Wraps grid coordinates into the cell.
struct WrapPlaces {
  int size[3];
  ESPDIFF_HD Vec3d operator()(const Vec3d& p) const {
    return {wrapped(p.x, size[0]), wrapped(p.y, size[1]), wrapped(p.z, size[2])};
  }
};

/// [point] its charge at grid coordinates. @param places from points to grid coordinates
template <typename T, typename Places>
Buffer<GridCharge> place_charges(const std::vector<Vec3d>& points, const std::vector<T>& charges, Places places) {
  const Buffer<Vec3d> points_there = to_device(points);
  const Buffer<T> charges_there = to_device(charges);
  Buffer<GridCharge> placed(points.size());
  const Vec3d* const point = raw(points_there);
  const T* const charge = raw(charges_there);
  GridCharge* const to = raw(placed);
  for_each_index(placed.size(), [=] ESPDIFF_HD(std::size_t i) {
    const Vec3d u = places(point[i]);
    to[i] = {{u.x, u.y, u.z}, static_cast<double>(charge[i]), 0, 0};
  });
  return placed;
}

/// Centred B-spline of an order at a whole or half number, by its recursion.
double centred_spline(int order, double x) {
  const double from_left = x + 0.5 * order;
  if (from_left <= 0 || from_left >= order) return 0;
  if (order == 2) return 1 - std::fabs(x);
  return (from_left * centred_spline(order - 1, x + 0.5) + (order - from_left) * centred_spline(order - 1, x - 0.5)) /
         (order - 1);
}

/// [mode] one over the transform of the centred spline at whole numbers: deconvolves the splines along one axis.
template <typename T>
Buffer<T> spline_factors(int size, const PmeOptions& options) {
  std::vector<double> spline(static_cast<std::size_t>(options.order / 2 + 1));
  for (std::size_t n = 0; n < spline.size(); ++n) spline[n] = centred_spline(options.order, static_cast<double>(n));
  std::vector<T> factors(static_cast<std::size_t>(size));
  for (int k = 0; k < size; ++k) {
    double sum = spline[0];
    for (std::size_t n = 1; n < spline.size(); ++n)
      sum += 2 * spline[n] * std::cos(2 * kPi * k * static_cast<double>(n) / size);
    const double factor = options.compatible || options.smooth_samples ? 1 / (sum * sum) : 1 / sum;
    const bool at_half_frequency = 2 * k == size && !options.compatible;
    factors[static_cast<std::size_t>(k)] = static_cast<T>(at_half_frequency ? 0 : factor);
  }
  return to_device(factors);
}

/// [atom] positions in parts of the cell's edges, from the lattice's first point.
std::vector<Vec3d> cell_parts(const std::vector<Vec3d>& positions, const PmeCell& cell, const PmeOptions& options) {
  const std::array<Vec3d, 3> reciprocal = reciprocal_edges(cell);
  const Vec3d origin = lattice_over(cell, options.size).origin;
  std::vector<Vec3d> parts;
  for (const Vec3d& p : positions) {
    const Vec3d d = p - origin;
    parts.push_back({dot(d, reciprocal[0]), dot(d, reciprocal[1]), dot(d, reciprocal[2])});
  }
  return parts;
}

/// The mean of the direct part of a net charge Q, C pi Q / (beta^2 V): taken off, it keeps the mean over the cell at 0.
double direct_mean(double net, const PmeCell& cell, const PmeOptions& options) {
  const double beta = options.ewald_factor;
  return coulomb_in_kt(options.temperature_K) * kPi * net /
         (beta * beta * dot(cell.edges[0], cross(cell.edges[1], cell.edges[2])));
}

/// The direct part of the sum over charges. @param parts of the cell's edges
template <typename T>
ChargeSums direct_sums(const std::vector<Vec3d>& parts, const std::vector<T>& charges, const PmeCell& cell,
                       const PmeOptions& options) {
  const double coulomb = coulomb_in_kt(options.temperature_K);
  std::vector<PointCharge> points;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (charges[i] != 0) points.push_back({parts[i], coulomb * static_cast<double>(charges[i])});
  }
  return ChargeSums(std::move(points), cell.edges, options.ewald_factor);
}

void add_direct_part(const std::vector<Vec3d>& positions, const std::vector<float>& charges, const PmeCell& cell,
                     const PmeOptions& options, MapGrid& map) {
  map.charge_sums =
      std::make_shared<ChargeSums>(direct_sums(cell_parts(positions, cell, options), charges, cell, options));
  double net = 0;
  for (const float q : charges) net += static_cast<double>(q);
  map.zero = direct_mean(net, cell, options);
  constexpr double kUsualSamples = 5e4;  // vertices of a surface
  require_work(kUsualSamples * map.charge_sums->n_terms(),
               option("ewaldfactor") + ": " + formatted(options.ewald_factor) +
                   " makes each value of the potential a sum over all charges within " +
                   formatted(kDirectReach / options.ewald_factor) + " A, " + formatted(map.charge_sums->n_terms()) +
                   " terms",
               "give a larger one (0.25 is usual)");
}

double scale_of(double volume, const PmeOptions& options) {
  if (options.compatible) {
    volume = std::trunc(volume);
    if (volume < 1)
      throw InputError("the cell's volume is below 1 A^3, which PMEPot truncates to 0; leave out `compatible`");
  }
  return coulomb_in_kt(options.temperature_K) / (kPi * volume);
}

/// The grid's values without the gaps between its slabs.
template <typename T>
void copy_values(FourierGrid<T>& grid, const std::array<int, 3>& size, Buffer<float>& values) {
  const std::size_t slab = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]),
                    stride = grid.slab_stride();
  values.resize(slab * static_cast<std::size_t>(size[2]));
  const T* const from = grid.values();
  float* const to = raw(values);
  for_each_index(values.size(),
                 [=] ESPDIFF_HD(std::size_t i) { to[i] = static_cast<float>(from[i / slab * stride + i % slab]); });
}

/// Spreads charges over the grid.
template <typename T>
void spread_on(FourierGrid<T>& grid, Buffer<GridCharge> placed, const PmeOptions& options) {
  const SortedCharges<T> sorted = sort_charges<T>(std::move(placed), options.size, options.order);
#if defined(ESPDIFF_BACKEND_CUDA)
  spread_by_points(sorted, grid.values(), grid.slab_stride());
#else
  spread_by_slabs(sorted, grid.values(), grid.slab_stride());
#endif
}

/// The weights of a reading on the grid: the transpose of the map's splines, or of its linear interpolation.
template <typename T>
void spread_reading(FourierGrid<T>& grid, const MapGrid& map, const WeightedPlaces& reading,
                    const PmeOptions& options) {
  if (map.spline_order != 0) {
    const WrapPlaces into_cell{{options.size[0], options.size[1], options.size[2]}};
    spread_on(grid, place_charges(reading.place, reading.weight, into_cell), options);
    return;
  }
  const SparseValues sparse = spread_linearly(map, reading);
  const std::size_t slab = static_cast<std::size_t>(options.size[0]) * static_cast<std::size_t>(options.size[1]),
                    stride = grid.slab_stride();
  const Buffer<std::size_t> points = to_device(sparse.point);
  const Buffer<float> added = to_device(sparse.value);
  const std::size_t* const point = raw(points);
  const float* const value = raw(added);
  T* const values = grid.values();
  for_each_index(stride * static_cast<std::size_t>(options.size[2]),
                 [=] ESPDIFF_HD(std::size_t i) { values[i] = T(0); });
  for_each_index(points.size(), [=] ESPDIFF_HD(std::size_t n) {
    values[point[n] / slab * stride + point[n] % slab] = static_cast<T>(value[n]);
  });
}

/// Subtracts from the grid what moving the zero to the bulk took off the reading.
/// @param all the sum of the reading's weights
template <typename T>
void subtract_bulk(FourierGrid<T>& grid, const MapGrid& map, double all) {
  const MapOrigin& origin = *map.origin;
  MapGrid bulk;
  bulk.lattice = map.lattice;
  bulk.periodic = true;
  bulk.spline_order = map.spline_order;
  bulk.values = bulk_weights(map.lattice, origin.solute, origin.bulk_distance_A);
  bulk.values = lattice_values(bulk);  // splines at grid points are symmetric: this is their transpose too
  const std::size_t slab =
                        static_cast<std::size_t>(map.lattice.size[0]) * static_cast<std::size_t>(map.lattice.size[1]),
                    stride = grid.slab_stride();
  const float* const subtracted = raw(bulk.values);
  T* const values = grid.values();
  for_each_index(bulk.values.size(), [=] ESPDIFF_HD(std::size_t i) {
    values[i / slab * stride + i % slab] -= static_cast<T>(all * static_cast<double>(subtracted[i]));
  });
}

std::shared_ptr<const MapOrigin> origin_of(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                           const PmeCell& cell, const PmeOptions& options,
                                           const RigidTransform& to_map) {
  auto origin = std::make_shared<MapOrigin>();
  origin->method = PotentialMethod::kPme;
  origin->positions = positions;
  origin->to_map = to_map;
  origin->charges = charges;
  origin->cell = cell;
  origin->pme = options;
  return origin;
}

double sum_of(const std::vector<double>& weights) {
  double sum = 0;
  for (const double w : weights) sum += w;
  return sum;
}

}  // namespace

template <typename T>
FourierGrid<T>& PmeSolver::Kept<T>::of_size(std::array<int, 3> wanted) {
  if (!grid || size != wanted) {
    grid.reset();
    grid = make_fourier_grid<T>(wanted);
    size = wanted;
  }
  return *grid;
}

template <typename T>
void PmeSolver::convolve(FourierGrid<T>& grid, const PmeCell& cell, const PmeOptions& options, MapGrid& map) {
  Influence<T> influence{};
  Buffer<T> factors[3];
  const std::array<Vec3d, 3> reciprocal = reciprocal_edges(cell);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    factors[axis] = spline_factors<T>(options.size[axis], options);
    influence.size[axis] = options.size[axis];
    influence.reciprocal[axis] = static_cast<Vec3<T>>(reciprocal[axis]);
    influence.spline[axis] = raw(factors[axis]);
  }
  influence.exponent = static_cast<T>(-kPi * kPi / (options.ewald_factor * options.ewald_factor));
  influence.scale = static_cast<T>(scale_of(checked_volume(cell), options));
  grid.convolve(influence);
  copy_values(grid, options.size, map.values);
}

template <typename T>
void PmeSolver::solve(Kept<T>& kept, Buffer<GridCharge> placed, const PmeCell& cell, const PmeOptions& options,
                      MapGrid& map, const Progress& progress) {
  FourierGrid<T>& grid = kept.of_size(options.size);
  progress.report("potential", 0.1);
  spread_on(grid, std::move(placed), options);
  progress.report("potential", 0.5);
  convolve(grid, cell, options, map);
  progress.report("potential", 1.0);
}

std::shared_ptr<MapGrid> PmeSolver::potential(const std::vector<Vec3d>& positions, const std::vector<float>& charges,
                                              const PmeCell& cell, const PmeOptions& options,
                                              const RigidTransform& to_map, const Progress& progress) {
  check_charges(positions, charges);
  check_options(options);
  check_memory(options);
  scale_of(checked_volume(cell), options);  // before any work
  auto map = std::make_shared<MapGrid>();
  // A million atoms are copied while others are sent to the device.
  constexpr std::size_t kManyAtoms = 200000;
  std::future<std::shared_ptr<const MapOrigin>> origin =
      std::async(positions.size() < kManyAtoms ? std::launch::deferred : std::launch::async,
                 [&] { return origin_of(positions, charges, cell, options, to_map); });
  Buffer<GridCharge> placed = place_charges(positions, charges, GridPlaces(cell, options));
  if (options.precision == Precision::kDouble) {
    solve(double_, std::move(placed), cell, options, *map, progress);
  } else {
    solve(single_, std::move(placed), cell, options, *map, progress);
  }
  map->origin = origin.get();
  map->lattice = lattice_over(cell, options.size);
  map->unit = PotentialUnit::kKtPerE;
  map->periodic = true;
  map->spline_order = options.smooth_samples ? options.order : 0;
  if (options.part == PmePart::kFull) add_direct_part(positions, charges, cell, options, *map);
  set_index_transform(map->lattice, to_map, "the potential", map->to_index);
  return map;
}

template <typename T>
void PmeSolver::solve_transposed(Kept<T>& kept, const MapGrid& map, const WeightedPlaces& reading, MapGrid& solution) {
  const MapOrigin& origin = *map.origin;
  FourierGrid<T>& grid = kept.of_size(origin.pme.size);
  spread_reading(grid, map, reading, origin.pme);
  if (origin.bulk_distance_A >= 0) subtract_bulk(grid, map, sum_of(reading.weight));
  convolve(grid, origin.cell, origin.pme, solution);
}

std::vector<double> PmeSolver::contributions(const MapGrid& map, const WeightedPlaces& reading,
                                             const std::vector<ProbeCharge>& probes) {
  const MapOrigin& origin = *map.origin;
  const PmeOptions& options = origin.pme;
  MapGrid solution;
  solution.lattice = map.lattice;
  solution.periodic = true;
  solution.spline_order = options.order;
  if (options.precision == Precision::kDouble) {
    solve_transposed(double_, map, reading, solution);
  } else {
    solve_transposed(single_, map, reading, solution);
  }
  const std::vector<Vec3d> places = charge_places(origin, probes);
  std::vector<Vec3d> on_grid(places.size());
  std::transform(places.begin(), places.end(), on_grid.begin(), GridPlaces(origin.cell, options));
  const std::vector<float> smooth = values_at(solution, on_grid);
  std::vector<double> result(smooth.begin(), smooth.end());
  if (options.part == PmePart::kFull) {
    std::vector<Vec3d> parts = reading.place;
    for (Vec3d& p : parts) {
      for (int axis = 0; axis < 3; ++axis) p[axis] /= options.size[static_cast<std::size_t>(axis)];
    }
    const ChargeSums sums = direct_sums(parts, reading.weight, origin.cell, options);
    const ChargeSumsView view = sums.view();
    const Buffer<Vec3d> at_atoms = to_device(cell_parts(places, origin.cell, options));
    Buffer<double> direct(result.size());
    const Vec3d* const at = raw(at_atoms);
    double* const out = raw(direct);
    for_each_index(result.size(), [=] ESPDIFF_HD(std::size_t i) {
      const double part[3] = {at[i].x, at[i].y, at[i].z};
      out[i] = view.direct(part);
    });
    const std::vector<double> found = to_host(direct);
    const double mean = origin.bulk_distance_A < 0 ? direct_mean(sum_of(reading.weight), origin.cell, options) : 0.0;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += found[i] - mean;
  }
  scale_by_charges(origin, probes, result);
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
