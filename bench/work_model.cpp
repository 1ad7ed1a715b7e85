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
// Operations: the squared distance and an exponential of seventeen; sums of value and slope.
constexpr double kGaussian = 9 + 17, kSlopes = 8;

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

std::vector<Vec3f> centroids(const espdiff::Mesh& mesh) {
  std::vector<Vec3f> points;
  for (const espdiff::Triangle& triangle : mesh.triangles) {
    const Vec3f& a = mesh.positions[triangle[0]];
    points.push_back((1.0F / 3.0F) * (a + mesh.positions[triangle[1]] + mesh.positions[triangle[2]]));
  }
  return points;
}

/// Points and Gaussians in whose reach they are; 0 above 10,000 atoms.
double n_pairs(const Side& side, const std::vector<Vec3f>& points) {
  const std::size_t n_atoms = side.widths.size();
  constexpr std::size_t kMostAtoms = 10000;
  if (n_atoms > kMostAtoms) return 0;
  double pairs = 0;
  for (const Vec3f& point : points) {
    for (std::size_t i = 0; i < n_atoms; ++i) {
      const Vec3f d = point - static_cast<Vec3f>(side.molecule.positions[i]);
      const float reach = static_cast<float>(kReachInWidths) * side.widths[i];
      if (dot(d, d) < reach * reach) pairs += 1;
    }
  }
  return pairs;
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
  const espdiff::Mesh mesh = in.engine->download(in.mapped);
  const double n = static_cast<double>(mesh.triangles.size());
  return {(kTriangle + 2 * kPoint) * n, (kGaussian + kSlopes) * n_pairs(in.target, centroids(mesh))};
}

Work project_work(const StageInputs& in) {
  const std::vector<Vec3f> points = in.engine->download(in.source.raw).positions;
  return {2 * kVector * static_cast<double>(points.size()), 2 * (kGaussian + kSlopes) * n_pairs(in.source, points)};
}

Work morph_work(const StageInputs& in, int n_steps) {
  const std::vector<Vec3f> points = in.engine->download(in.start).positions;
  // The sums of value, slopes and their change, and the atoms' velocity weighted by their Gaussians.
  constexpr double kFlow = kSlopes + 2 + 6;
  const double evaluation = 2 * (kGaussian + kSlopes) + kGaussian + kFlow;
  return {2 * kVector * static_cast<double>(points.size()) * n_steps,
          evaluation * n_pairs(in.source, points) * n_steps};
}

Work vertex_residues_work(const StageInputs& in) {
  const std::vector<Vec3f> points = in.engine->download(in.start).positions;
  return {(kVector + kIndex) * static_cast<double>(points.size()), kGaussian * n_pairs(in.source, points)};
}

Work distances_work(const StageInputs& in) {
  constexpr double kPointToTriangle = 60;
  double v = 0, t = 0;
  for (const espdiff::MeshPtr& mesh : {in.mapped, in.target.surface}) {
    v += static_cast<double>(in.engine->n_vertices(mesh));
    t += static_cast<double>(in.engine->n_triangles(mesh));
  }
  return {kVector * v + kTriangle * t + kPoint * (v + t), kPointToTriangle * (v + t)};
}

Work poisson_boltzmann_work(std::size_t n_points, int n_cycles) {
  // Read and written: solution, residual and direction; each way through the multigrid's finest level, the correction.
  // Read besides: the residual each way, and a code of the operator's coefficients three times.
  constexpr double kFinest = (3 + 2) * 2 * kPoint + 2 * kPoint + 3;
  // An eighth of the points each, with a right-hand side of their own and three coefficients.
  constexpr double kCoarser = (2 * 2 * kPoint + 2 * kPoint + 2 * 3 * kPoint) / 7;
  // Product with the operator, two sweeps, residual, transfers to and from the coarser level, and the vectors' sums.
  constexpr double kOperations = 13 + 2 * 14 + 14 + 4 + 4 + 8, kAllLevels = 8.0 / 7;
  const double n = static_cast<double>(n_points) * n_cycles;
  return {(kFinest + kCoarser) * n, kOperations * kAllLevels * n};
}

}  // namespace espdiff_bench
