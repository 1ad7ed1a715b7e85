// work_model.cpp: counts bytes and operations of the stages.
#include "work_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/engine.h"

namespace espdiff_bench {
namespace {

using espdiff::Vec3d;
using espdiff::Vec3f;

constexpr double kReachInWidths = 4.5;
constexpr double kPoint = 4, kVector = 16, kIndex = 4, kTriangle = 12;  // bytes

double n_points(const espdiff::GridPtr& grid, const StageInputs& in) {
  return static_cast<double>(in.engine->download(grid).values.size());
}

/// Lattice points that sampling the field at the mesh's vertices touches.
double n_points_touched(const StageInputs& in, int margin) {
  const espdiff::Lattice lattice = in.engine->download(in.target_distance_field).lattice;
  const std::size_t nx = static_cast<std::size_t>(lattice.size[0]), ny = static_cast<std::size_t>(lattice.size[1]);
  std::vector<char> touched(lattice.n_points(), 0);
  for (const Vec3f& p : in.engine->download(in.start).positions) {
    const Vec3d at = static_cast<Vec3d>(p) - lattice.origin;
    std::size_t base[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double c = std::floor(at[axis] / in.spacing()) - margin;
      const int most = lattice.size[static_cast<std::size_t>(axis)] - 2 - 2 * margin;
      base[axis] = static_cast<std::size_t>(std::clamp(static_cast<int>(c), 0, most));
    }
    const std::size_t width = 2 + 2 * static_cast<std::size_t>(margin);
    for (std::size_t k = 0; k < width; ++k) {
      for (std::size_t j = 0; j < width; ++j) {
        for (std::size_t i = 0; i < width; ++i) touched[base[0] + i + nx * (base[1] + j + ny * (base[2] + k))] = 1;
      }
    }
  }
  return static_cast<double>(std::count(touched.begin(), touched.end(), 1));
}

}  // namespace

Work density_work(const StageInputs& in) {
  double pairs = 0;
  for (const float width : in.source.widths) {
    const double reach = kReachInWidths * static_cast<double>(width) / in.spacing();
    pairs += 2 * 3.14159265358979 * reach * reach * reach;  // a disc of rows, each as long as the reach
  }
  return {kPoint * n_points(in.source.density, in), 2 * pairs};
}

Work isosurface_work(const StageInputs& in) {
  const double v = static_cast<double>(in.engine->n_vertices(in.source.raw)),
               t = static_cast<double>(in.engine->n_triangles(in.source.raw));
  return {kPoint * n_points(in.source.density, in) + (kVector + kIndex) * v + (kTriangle + 6 * kIndex) * t, 0};
}

Work density_field_work(const StageInputs& in) {
  const double n = n_points(in.target.density, in);
  return {(kPoint + kVector) * n, 7 * n};  // three differences and quotients, and the isovalue
}

Work deform_iteration_work(const StageInputs& in, bool tricubic) {
  const double v = static_cast<double>(in.engine->n_vertices(in.start)),
               t = static_cast<double>(in.engine->n_triangles(in.start)), ring = 3 * t / v;
  // First pass: positions, rest and one-rings in, Laplacians out. Second: positions, Laplacians, one-rings, strengths,
  // path lengths and the field in; positions and path lengths out.
  const double first = 3 * kVector + kIndex * (1 + ring), second = 3 * kVector + kIndex * (1 + ring) + 3 * kPoint;
  const double field = kVector * n_points_touched(in, tricubic ? 1 : 0);
  // Two umbrellas; seven interpolations of four numbers, or twenty-one of four points each; the forces.
  const double umbrella = 4 * ring + 9, sampling = tricubic ? 21 * 4 * 7 + 3 * 16 : 7 * 4 * 3 + 9;
  return {(first + second) * v + field, (2 * umbrella + sampling + 40) * v};
}

Work fit_work(const StageInputs& in) {
  const std::size_t n_atoms = in.target.widths.size();
  const espdiff::Mesh mesh = in.engine->download(in.mapped);
  constexpr std::size_t kMostAtoms = 10000;
  if (n_atoms > kMostAtoms) return {};
  double pairs = 0;
  for (const espdiff::Triangle& triangle : mesh.triangles) {
    const Vec3f& a = mesh.positions[triangle[0]];
    const Vec3f centroid = (1.0F / 3.0F) * (a + mesh.positions[triangle[1]] + mesh.positions[triangle[2]]);
    for (std::size_t i = 0; i < n_atoms; ++i) {
      const Vec3f d = centroid - static_cast<Vec3f>(in.target.molecule.positions[i]);
      const float reach = static_cast<float>(kReachInWidths) * in.target.widths[i];
      if (dot(d, d) < reach * reach) pairs += 1;
    }
  }
  // The squared distance, an exponential of seventeen operations, and the sums of value and slope.
  return {(kTriangle + 2 * kPoint) * static_cast<double>(mesh.triangles.size()), (9 + 17 + 8) * pairs};
}

}  // namespace espdiff_bench
