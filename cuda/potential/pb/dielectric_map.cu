// dielectric_map.cu: dielectrics of faces from the solute's shape or from Gaussians; where ions are excluded.
#include "cuda/potential/pb/dielectric_map.h"

#include <algorithm>
#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The lattice of the faces towards the next point along an axis.
CubicLattice faces_along(CubicLattice lattice, int axis) {
  lattice.origin[axis] += 0.5F * lattice.spacing;
  return lattice;
}

/// [count] dielectric of a face, by how many of the nine samples lie in the solute.
struct SmoothDielectric {
  float of[10];
};

/// Faces along one axis, from the depths at the centres of all three kinds of faces.
struct NinePoint {
  const float* own;
  const float* side;
  const float* other;
  std::size_t along, across, up;  ///< to the next point along the own axis, along the side's, along the other's
  SmoothDielectric dielectric;

  ESPDIFF_INLINE static int in_solute(float depth) { return depth > 0.0F ? 1 : 0; }
  ESPDIFF_INLINE float value(std::size_t p) const {
    const std::size_t q = p + along;
    const int n =
        in_solute(own[p]) +
        (in_solute(side[p]) + in_solute(side[p - across]) + in_solute(side[q]) + in_solute(side[q - across])) +
        (in_solute(other[p]) + in_solute(other[p - up]) + in_solute(other[q]) + in_solute(other[q - up]));
    return dielectric.of[n];
  }
};

void smooth_faces(const GridSize& size, const Buffer<float> (&depths)[3], int axis, const SmoothDielectric& dielectric,
                  Buffer<float>& out) {
  const std::size_t steps[3] = {1, size.row(), size.plane()};
  const int side = (axis + 1) % 3, other = (axis + 2) % 3;
  const NinePoint faces{raw(depths[axis]), raw(depths[side]), raw(depths[other]), steps[axis],
                        steps[side],       steps[other],      dielectric};
  const std::size_t n = size.points(), reach = steps[0] + steps[1] + steps[2];
  float* const values = raw(out);
  // Faces on the grid's border are far from atoms.
  for_each_index(n, [=] ESPDIFF_HD(std::size_t p) {
    values[p] = p >= reach && p + reach < n ? faces.value(p) : dielectric.of[0];
  });
}

void fill_by_nine_points(const SoluteShape& shape, const CubicLattice& lattice, const PoissonBoltzmannOptions& options,
                         GridOperator& on_grid) {
  Buffer<float> depths[3];
  for (int axis = 0; axis < 3; ++axis) shape.depths(faces_along(lattice, axis), depths[axis]);
  SmoothDielectric dielectric{};
  for (int n = 0; n < 10; ++n)
    dielectric.of[n] = static_cast<float>(9 / (n / options.solute_dielectric + (9 - n) / options.solvent_dielectric));
  smooth_faces(on_grid.size, depths, 0, dielectric, on_grid.ex);
  smooth_faces(on_grid.size, depths, 1, dielectric, on_grid.ey);
  smooth_faces(on_grid.size, depths, 2, dielectric, on_grid.ez);
}

/// The dielectric between two points: the two parts in series; they meet where the depth is zero.
struct EdgeDielectric {
  float inverse_solute, inverse_solvent;

  ESPDIFF_INLINE float between(float a, float b) const {
    const float high = larger(a, b), low = smaller(a, b);
    const float cut = high / larger(high - low, 1e-6F);
    const float part = low > 0.0F ? 1.0F : high > 0.0F ? cut : 0.0F;
    return 1.0F / (part * inverse_solute + (1.0F - part) * inverse_solvent);
  }
};

#if !defined(__CUDACC__)
ESPDIFF_MULTIVERSION void set_edges(const EdgeDielectric& dielectric, const float* depths, std::size_t step,
                                    std::size_t first, std::size_t last, float* out) {
  for (std::size_t p = first; p < last; ++p) out[p] = dielectric.between(depths[p], depths[p + step]);
}
#endif

void fill_by_edges(const SoluteShape& shape, const CubicLattice& lattice, const PoissonBoltzmannOptions& options,
                   GridOperator& on_grid) {
  Buffer<float>& depths = on_grid.diagonal;  // until k takes its place
  shape.depths(lattice, depths);
  const EdgeDielectric dielectric{static_cast<float>(1 / options.solute_dielectric),
                                  static_cast<float>(1 / options.solvent_dielectric)};
  Buffer<float>* const faces[3] = {&on_grid.ex, &on_grid.ey, &on_grid.ez};
  const std::size_t steps[3] = {1, on_grid.size.row(), on_grid.size.plane()}, n = on_grid.size.points();
  const float* const from = raw(depths);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t step = steps[axis];
    float* const out = raw(*faces[axis]);
#if defined(__CUDACC__)
    for_each_index(
        n, [=] ESPDIFF_HD(std::size_t p) { out[p] = dielectric.between(from[p], from[p + step < n ? p + step : p]); });
#else
    const std::size_t plane = on_grid.size.plane();
    for_each_index(static_cast<std::size_t>(on_grid.size.nz), [=](std::size_t k) {
      const std::size_t first = k * plane, end = first + plane, last = std::min(end, n - step);
      set_edges(dielectric, from, step, first, last, out);
      for (std::size_t p = std::max(first, last); p < end; ++p) out[p] = dielectric.between(from[p], from[p]);
    });
#endif
  }
}

/// Li et al. 2013: 1 - prod_i (1 - exp(-r^2 / (sigma a_i)^2)) of the solute's dielectric and the rest of the solvent's.
struct GaussianDielectric {
  AtomCellsView atoms;
  float solute, solvent;

  ESPDIFF_INLINE float at(Vec3f p) const {
    float empty = 1;
    visit_atom_runs(atoms, p, atoms.max_reach, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t a = begin; a < end; ++a) {
        const float dx = p.x - atoms.x[a], dy = p.y - atoms.y[a], dz = p.z - atoms.z[a];
        const float square = dx * dx + dy * dy + dz * dz;
        if (square < atoms.reach[a] * atoms.reach[a])
          empty *= 1.0F - exp_of_negative(larger(atoms.exponent[a] * square, -80.0F));
      }
    });
    return (1.0F - empty) * solute + empty * solvent;
  }
};

void fill_gaussian(const std::vector<PbAtom>& atoms, const CubicLattice& lattice,
                   const PoissonBoltzmannOptions& options, GridOperator& on_grid) {
  std::vector<Vec3d> positions;
  std::vector<float> widths;
  for (const PbAtom& atom : atoms) {
    positions.push_back(atom.position);
    // exp(-r^2 / (sigma a)^2) is a Gaussian of standard deviation sigma a / sqrt(2).
    widths.push_back(static_cast<float>(options.gaussian_sigma * static_cast<double>(atom.radius) / std::sqrt(2.0)));
  }
  const auto cells = make_atom_cells(positions, widths, std::vector<std::int32_t>(atoms.size(), 0));
  const GaussianDielectric dielectric{cells->view(), static_cast<float>(options.solute_dielectric),
                                      static_cast<float>(options.solvent_dielectric)};
  Buffer<float>* const faces[3] = {&on_grid.ex, &on_grid.ey, &on_grid.ez};
  const GridSize size = on_grid.size;
  for (int axis = 0; axis < 3; ++axis) {
    const CubicLattice at = faces_along(lattice, axis);
    float* const out = raw(*faces[axis]);
    for_each_index(size.points(), [=] ESPDIFF_HD(std::size_t p) {
      out[p] = dielectric.at(at.point(static_cast<int>(p % size.row()),
                                      static_cast<int>(p / size.row() % static_cast<std::size_t>(size.ny)),
                                      static_cast<int>(p / size.plane())));
    });
  }
}

void fill_faces(const std::vector<PbAtom>& atoms, const CubicLattice& lattice, const PoissonBoltzmannOptions& options,
                GridOperator& on_grid, std::shared_ptr<const SoluteShape>& shape) {
  const bool molecular = options.dielectric_boundary == DielectricBoundary::kMolecular;
  if (shape == nullptr)
    shape = std::make_shared<SoluteShape>(atoms, molecular ? static_cast<float>(options.probe_radius_A) : 0.0F);
  if (options.smoothing == DielectricSmoothing::kNinePoint) {
    fill_by_nine_points(*shape, lattice, options, on_grid);
  } else {
    fill_by_edges(*shape, lattice, options, on_grid);
  }
}

}  // namespace

void fill_operator(const std::vector<PbAtom>& atoms, const CubicLattice& lattice,
                   const PoissonBoltzmannOptions& options, float stern_k, GridOperator& on_grid,
                   std::shared_ptr<const SoluteShape>* shape) {
  on_grid.size = {lattice.size[0], lattice.size[1], lattice.size[2]};
  const std::size_t n = on_grid.size.points();
  for (Buffer<float>* buffer : {&on_grid.ex, &on_grid.ey, &on_grid.ez, &on_grid.diagonal}) buffer->resize(n);
  if (options.dielectric_boundary == DielectricBoundary::kGaussian) {
    fill_gaussian(atoms, lattice, options, on_grid);
  } else {
    std::shared_ptr<const SoluteShape> own;
    fill_faces(atoms, lattice, options, on_grid, shape == nullptr ? own : *shape);
  }
  float* const k = raw(on_grid.diagonal);
  if (stern_k > 0) {
    std::vector<PbAtom> enlarged = atoms;
    for (PbAtom& atom : enlarged) atom.radius += static_cast<float>(options.ion_radius_A);
    SoluteShape(enlarged, 0.0F).depths(lattice, on_grid.diagonal);
    for_each_index(n, [=] ESPDIFF_HD(std::size_t p) { k[p] = k[p] > 0.0F ? 0.0F : stern_k; });
  } else {
    for_each_index(n, [=] ESPDIFF_HD(std::size_t p) { k[p] = 0.0F; });
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
