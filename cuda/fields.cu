// fields.cu: density and distance fields with their gradients.
#include "fields.h"

#include <cfloat>

#include "triangle_tree.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Gradient at a lattice point: central differences, one-sided on the border.
ESPDIFF_INLINE Vec3f lattice_gradient(const CubicLattice& lattice, const float* values, int i, int j, int k) {
  const int at[3] = {i, j, k};
  const std::size_t stride[3] = {1, static_cast<std::size_t>(lattice.size[0]),
                                 static_cast<std::size_t>(lattice.size[0]) * static_cast<std::size_t>(lattice.size[1])};
  const float* const here = values + lattice.index(i, j, k);
  Vec3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const bool low = at[axis] > 0, high = at[axis] + 1 < lattice.size[axis];
    const float difference = (high ? here[stride[axis]] : *here) - (low ? *(here - stride[axis]) : *here);
    gradient[axis] = difference / (lattice.spacing * (low && high ? 2.0F : 1.0F));
  }
  return gradient;
}

std::size_t n_rows(const CubicLattice& lattice) { return static_cast<std::size_t>(lattice.size[1]) * static_cast<std::size_t>(lattice.size[2]); }

/// Distances of the points of one row: each starts from its predecessor's, which bounds it by one spacing more.
ESPDIFF_INLINE void distance_row(const CubicLattice& lattice, const TriangleTreeView& tree, const float* density, float isovalue, LatticeRow row,
                                 float* distance) {
  float bound = FLT_MAX;
  for (int i = 0; i < lattice.size[0]; ++i) {
    const std::size_t point = lattice.index(i, row.j, row.k);
    const float squared = squared_distance(tree, lattice.point(i, row.j, row.k), bound);
    const float length = sqrtf(squared);
    distance[point] = density[point] > isovalue ? length : -length;
    const float next = length + 1.0001F * lattice.spacing;
    bound = next * next;
  }
}

}  // namespace

std::shared_ptr<SurfaceField> density_field(const DensityGrid& density, float isovalue) {
  auto field = std::make_shared<SurfaceField>();
  const CubicLattice lattice = field->lattice = density.lattice;
  field->values.resize(lattice.n_points());
  const float* const values = raw(density.values);
  Vec4f* const out = raw(field->values);
  for_each_index(n_rows(lattice), [=] ESPDIFF_HD(std::size_t row) {
    const LatticeRow at = lattice_row(lattice, row);
    for (int i = 0; i < lattice.size[0]; ++i) {
      const std::size_t point = lattice.index(i, at.j, at.k);
      out[point] = make_vec4(lattice_gradient(lattice, values, i, at.j, at.k), values[point] - isovalue);
    }
  });
  return field;
}

std::shared_ptr<SurfaceField> distance_field(const DensityGrid& density, float isovalue, const SurfaceMesh& surface, float threshold_A,
                                             const Progress& progress) {
  std::shared_ptr<SurfaceField> field = density_field(density, isovalue);
  const TriangleTree tree_of_surface = make_triangle_tree(surface);
  const TriangleTreeView tree = tree_of_surface.view();
  const CubicLattice lattice = field->lattice;
  Buffer<float> distances(lattice.n_points());
  const float* const values = raw(density.values);
  float* const distance = raw(distances);
  Vec4f* const out = raw(field->values);

  constexpr std::size_t kParts = 8;  // between which the user may cancel
  for (std::size_t part = 0; part < kParts; ++part) {
    progress.report("distance field", static_cast<double>(part) / kParts);
    const std::size_t begin = n_rows(lattice) * part / kParts, end = n_rows(lattice) * (part + 1) / kParts;
    for_each_index(end - begin, [=] ESPDIFF_HD(std::size_t n) {
      distance_row(lattice, tree, values, isovalue, lattice_row(lattice, begin + n), distance);
    });
  }
  for_each_index(n_rows(lattice), [=] ESPDIFF_HD(std::size_t row) {
    const LatticeRow at = lattice_row(lattice, row);
    for (int i = 0; i < lattice.size[0]; ++i) {
      const std::size_t point = lattice.index(i, at.j, at.k);
      if (fabsf(distance[point]) > threshold_A) {
        out[point] = make_vec4(lattice_gradient(lattice, distance, i, at.j, at.k), distance[point]);
      }
    }
  });
  progress.report("distance field", 1.0);
  return field;
}

}  // namespace espdiff::ESPDIFF_BACKEND
