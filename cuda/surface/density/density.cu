// density.cu: the Gaussian density of the atoms on a lattice, gathered by points or added by slabs.
//
// Both forms add the same terms in the same order (atoms ascending in the cell list), so they agree to the last bit. A
// term is included if the point lies within the atom's reach along each axis and the Gaussian of its (y, z) distance
// exceeds the cutoff.
#include "cuda/surface/density/density.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Bytes per lattice point of the density and of its isosurface: inside flags, cases, vertex offsets. Fields check
/// their own memory.
constexpr double kBytesPerPoint = 4 + 1 + 1 + 4;

ESPDIFF_INLINE float axis_gaussian(float exponent, float delta) {
  return exp_of_negative(larger(exponent * delta * delta, -80.0F));
}

/// Smallest product of the y and z Gaussians that is included.
ESPDIFF_INLINE float row_floor() { return exp_of_negative(kCutoffExponent); }

ESPDIFF_INLINE float density_gather(const AtomCellsView& atoms, Vec3f p) {
  float sum = 0;
  const float floor = row_floor();
  const int x0 = atoms.clamped_cell(p.x - atoms.max_reach, 0), x1 = atoms.clamped_cell(p.x + atoms.max_reach, 0);
  const int y0 = atoms.clamped_cell(p.y - atoms.max_reach, 1), y1 = atoms.clamped_cell(p.y + atoms.max_reach, 1);
  const int z0 = atoms.clamped_cell(p.z - atoms.max_reach, 2), z1 = atoms.clamped_cell(p.z + atoms.max_reach, 2);
  for (int z = z0; z <= z1; ++z) {
    for (int y = y0; y <= y1; ++y) {
      const int row = atoms.size[0] * (y + atoms.size[1] * z);
      for (std::uint32_t a = atoms.first[row + x0]; a < atoms.first[row + x1 + 1]; ++a) {
        const float dx = p.x - atoms.x[a], dy = p.y - atoms.y[a], dz = p.z - atoms.z[a];
        const float reach = atoms.reach[a];
        if (fabsf(dx) > reach || fabsf(dy) > reach || fabsf(dz) > reach) continue;
        const float k = atoms.exponent[a];
        const float row_weight = axis_gaussian(k, dz) * axis_gaussian(k, dy);
        if (row_weight < floor) continue;
        sum += row_weight * axis_gaussian(k, dx);
      }
    }
  }
  return sum;
}

}  // namespace

CubicLattice density_lattice(const AtomCells& atoms, double spacing_A) {
  if (!(spacing_A > 0) || !std::isfinite(spacing_A)) {
    throw InputError("grid spacing " + formatted(spacing_A) + " A is not a positive number; 1 is usual");
  }
  const Vec3d extent = atoms.upper - atoms.lower;
  double n_points = 1;
  CubicLattice lattice{};
  for (int axis = 0; axis < 3; ++axis) {
    n_points *= std::ceil(extent[axis] / spacing_A) + 3;
  }
  const double coarser = coarsening_to_fit(n_points, kBytesPerPoint);
  if (coarser > 1) {
    const double fitting = spacing_A * coarser;
    const auto short_number = [](double value) { return formatted("%.4g", value); };
    throw MemoryError("a grid of spacing " + short_number(spacing_A) + " A over " + short_number(extent.x) + " x " +
                      short_number(extent.y) + " x " + short_number(extent.z) + " A has " + short_number(n_points) +
                      " points, which " + need_in_words(n_points, kBytesPerPoint) + "; a spacing of " +
                      short_number(std::ceil(1000 * fitting) / 1000) + " A would fit, or select fewer atoms");
  }
  for (int axis = 0; axis < 3; ++axis) lattice.size[axis] = static_cast<int>(std::ceil(extent[axis] / spacing_A) + 3);
  lattice.spacing = static_cast<float>(spacing_A);
  lattice.origin = static_cast<Vec3f>(atoms.lower - Vec3d{spacing_A, spacing_A, spacing_A});
  return lattice;
}

std::shared_ptr<DensityGrid> density_by_points(const AtomCells& atoms, const CubicLattice& lattice) {
  auto grid = std::make_shared<DensityGrid>();
  grid->lattice = lattice;
  grid->values.resize(lattice.n_points());
  const AtomCellsView view = atoms.view();
  float* const values = raw(grid->values);
  const std::size_t n_x = static_cast<std::size_t>(lattice.size[0]), n_y = static_cast<std::size_t>(lattice.size[1]);
  for_each_index(grid->values.size(), [=] ESPDIFF_HD(std::size_t point) {
    const int i = static_cast<int>(point % n_x);
    const int j = static_cast<int>(point / n_x % n_y);
    const int k = static_cast<int>(point / (n_x * n_y));
    values[point] = density_gather(view, lattice.point(i, j, k));
  });
  return grid;
}

#if !defined(ESPDIFF_BACKEND_CUDA)
namespace {

constexpr int kSlabLayers = 4;
constexpr int kVector = 8;     // row weights are added in groups of this many points
constexpr int kMaxAxis = 512;  // most lattice points that an atom reaches along an axis in slab form; otherwise the
                               // gather form is used

struct AxisRange {
  int begin, end;
};

/// Lattice points of [begin, end) within reach of the atom, by the gather form's test, so that both forms agree at the
/// border.
ESPDIFF_INLINE AxisRange points_in_reach(const CubicLattice& lattice, int axis, float centre, float reach, int begin,
                                         int end) {
  const float first = (centre - reach - lattice.origin[axis]) / lattice.spacing;
  const float last = (centre + reach - lattice.origin[axis]) / lattice.spacing;
  int from = std::max(begin, static_cast<int>(first) - 1), to = std::min(end, static_cast<int>(last) + 3);
  while (from < to && fabsf(lattice.coordinate(axis, from) - centre) > reach) ++from;
  while (to > from && fabsf(lattice.coordinate(axis, to - 1) - centre) > reach) --to;
  return {from, to};
}

template <int Groups>
ESPDIFF_INLINE void add_row(float* row, const float* gaussian, float weight) {
  for (int i = 0; i < Groups * kVector; ++i) row[i] += weight * gaussian[i];
}

ESPDIFF_INLINE void add_row_of(int groups, float* row, const float* gaussian, float weight) {
  switch (groups) {
    case 1: add_row<1>(row, gaussian, weight); break;
    case 2: add_row<2>(row, gaussian, weight); break;
    case 3: add_row<3>(row, gaussian, weight); break;
    default:
      for (std::ptrdiff_t g = 0; g < groups; ++g) add_row<1>(row + g * kVector, gaussian + g * kVector, weight);
  }
}

ESPDIFF_INLINE void axis_gaussians(const CubicLattice& lattice, int axis, AxisRange range, int padded, float centre,
                                   float k, float reach, float* gaussian) {
  for (int i = 0; i < padded; ++i) {
    const float delta = lattice.coordinate(axis, range.begin + i) - centre;
    const float value = axis_gaussian(k, delta);
    gaussian[i] = fabsf(delta) <= reach ? value : 0.0F;
  }
}

/// Adds one atom to the layers [z_begin, z_end).
ESPDIFF_INLINE void add_atom(const AtomCellsView& atoms, std::uint32_t a, const CubicLattice& lattice, int z_begin,
                             int z_end, float* values) {
  const float reach = atoms.reach[a], k = atoms.exponent[a];
  const AxisRange zs = points_in_reach(lattice, 2, atoms.z[a], reach, z_begin, z_end);
  if (zs.begin >= zs.end) return;
  const AxisRange ys = points_in_reach(lattice, 1, atoms.y[a], reach, 0, lattice.size[1]);
  AxisRange xs = points_in_reach(lattice, 0, atoms.x[a], reach, 0, lattice.size[0]);
  if (ys.begin >= ys.end || xs.begin >= xs.end) return;
  // Whole groups only, so that a row never runs past its end into another thread's row. The padding has weight 0.
  const int groups = (xs.end - xs.begin + kVector - 1) / kVector;
  xs.begin = std::min(xs.begin, lattice.size[0] - groups * kVector);
  alignas(64) float gaussian_x[kMaxAxis], gaussian_y[kMaxAxis], gaussian_z[kMaxAxis];
  axis_gaussians(lattice, 0, xs, groups * kVector, atoms.x[a], k, reach, gaussian_x);
  axis_gaussians(lattice, 1, ys, ys.end - ys.begin, atoms.y[a], k, reach, gaussian_y);
  axis_gaussians(lattice, 2, zs, zs.end - zs.begin, atoms.z[a], k, reach, gaussian_z);
  const float floor = row_floor();
  for (int z = zs.begin; z < zs.end; ++z) {
    for (int y = ys.begin; y < ys.end; ++y) {
      const float weight = gaussian_z[z - zs.begin] * gaussian_y[y - ys.begin];
      if (weight < floor) continue;
      add_row_of(groups, values + lattice.index(xs.begin, y, z), gaussian_x, weight);
    }
  }
}

ESPDIFF_MULTIVERSION void add_slab(const AtomCellsView& atoms, const CubicLattice& lattice, int z_begin, int z_end,
                                   float* values) {
  const std::ptrdiff_t layer = std::ptrdiff_t{atoms.size[0]} * atoms.size[1];
  const int z0 = atoms.clamped_cell(lattice.coordinate(2, z_begin) - atoms.max_reach, 2);
  const int z1 = atoms.clamped_cell(lattice.coordinate(2, z_end - 1) + atoms.max_reach, 2);
  const std::uint32_t end = atoms.first[layer * (z1 + 1)];
  for (std::uint32_t a = atoms.first[layer * z0]; a < end; ++a) add_atom(atoms, a, lattice, z_begin, z_end, values);
}

}  // namespace

std::shared_ptr<DensityGrid> density_by_slabs(const AtomCells& atoms, const CubicLattice& lattice) {
  const float widest_row = 2 * atoms.max_reach / lattice.spacing + 2 * kVector;
  // A padded row must fit into the lattice and into an atom's buffers.
  if (widest_row > static_cast<float>(kMaxAxis) || static_cast<float>(lattice.size[0]) < widest_row) {
    return density_by_points(atoms, lattice);
  }
  auto grid = std::make_shared<DensityGrid>();
  grid->lattice = lattice;
  grid->values.assign(lattice.n_points(), 0.0F);
  const AtomCellsView view = atoms.view();
  float* const values = raw(grid->values);
  const std::size_t n_slabs = static_cast<std::size_t>((lattice.size[2] + kSlabLayers - 1) / kSlabLayers);
  for_each_index(n_slabs, [=](std::size_t slab) {
    const int z_begin = static_cast<int>(slab) * kSlabLayers;
    add_slab(view, lattice, z_begin, std::min(z_begin + kSlabLayers, lattice.size[2]), values);
  });
  return grid;
}
#endif

}  // namespace espdiff::ESPDIFF_BACKEND
