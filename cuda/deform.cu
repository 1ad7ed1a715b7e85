// deform.cu: the force iteration, in two passes: umbrella Laplacians, then forces and the move.
#include "deform.h"

#include <utility>

#include "adjacency.h"
#include "base/error.h"
#include "sample.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Iterations between checks for convergence and cancellation: a check sums over all vertices and, on a device, waits
/// for it.
constexpr int kCheckInterval = 5;

/// Eigenvalues of the umbrella operator lie in [-2, 0], so that an explicit step along (1 - rho) L - rho L^2 is stable
/// for every rho while it is below 2 / 4.
constexpr double kLargestInternalStep = 0.5;

double internal_step(const DeformOptions& o) { return o.sigma * (1 - o.mu) * o.tangential_gain; }

void check_options(const DeformOptions& o) {
  if (!(o.sigma > 0)) throw InputError("sigma " + std::to_string(o.sigma) + " is not positive; 0.1 is usual");
  if (!(o.mu >= 0 && o.mu <= 1)) throw InputError("mu " + std::to_string(o.mu) + " is not between 0 and 1");
  if (!(o.rho >= 0 && o.rho <= 1)) throw InputError("rho " + std::to_string(o.rho) + " is not between 0 and 1");
  if (!(o.tangential_gain >= 0))
    throw InputError("the tangential gain, " + std::to_string(o.tangential_gain) +
                     ", is negative; 1 is the plain iteration");
  if (internal_step(o) > kLargestInternalStep) {
    throw InputError("sigma (1 - mu) times the tangential gain is " + std::to_string(internal_step(o)) + ", beyond " +
                     std::to_string(kLargestInternalStep) + " where the iteration becomes unstable; lower one of them");
  }
  if (o.max_iterations < 0)
    throw InputError("the number of iterations, " + std::to_string(o.max_iterations) + ", is negative");
  if (!(o.min_displacement_A >= 0))
    throw InputError("the smallest displacement, " + std::to_string(o.min_displacement_A) + " A, is negative");
}

/// What one iteration reads and writes.
struct Iteration {
  TopologyView topology;
  CubicLattice lattice;
  const Vec4f* field;
  const Vec4f* from;       // [vertex]
  const Vec4f* laplacian;  // [vertex] L of `from`, less that of the rest shape
  Vec4f* to;               // [vertex] w: how far the vertex moved
  float* way;              // [vertex] how far it has moved in all iterations
  float* strength;         // [vertex] s: positive while outside, negative while inside, halved at each crossing
  float step_external, step_tension, step_rigidity;  // sigma mu, g sigma (1 - mu)(1 - rho), g sigma (1 - mu) rho
  bool tricubic;
};

ESPDIFF_INLINE Vec4f field_at(const Iteration& it, Vec3f p) {
  return it.tricubic ? sample_tricubic(it.lattice, it.field, p) : sample_trilinear(it.lattice, it.field, p);
}

ESPDIFF_INLINE void move_vertex(const Iteration& it, std::size_t v) {
  const Vec4f x = it.from[v];
  const Vec4f laplacian = it.laplacian[v];
  const Vec4f laplacian_squared = umbrella(it.topology, it.laplacian, v);
  Vec3f internal = (it.step_tension * laplacian - it.step_rigidity * laplacian_squared).xyz();

  const Vec4f sample = field_at(it, x.xyz());
  float s = it.strength[v];
  if ((sample.w > 0) == (s > 0)) {
    s *= -0.5F;
    it.strength[v] = s;
  }
  const float length = norm(sample.xyz());
  Vec3f moved = internal;
  const bool has_neighbours = it.topology.first[v + 1] > it.topology.first[v];
  if (length > 1e-12F && has_neighbours) {
    const Vec3f n = (1.0F / length) * sample.xyz();
    moved = internal + (it.step_external * s - dot(internal, n)) * n;
  }
  const float distance = norm(moved);
  it.way[v] += distance;
  it.to[v] = make_vec4(x.xyz() + moved, distance);
}

}  // namespace

std::shared_ptr<SurfaceMesh> deform(const SurfaceMesh& mesh, const SurfaceMesh& rest_mesh, const SurfaceField& field,
                                    const DeformOptions& options, const std::string& stage, const Progress& progress,
                                    DeformReport* report) {
  check_options(options);
  const std::size_t n = mesh.n_vertices();
  if (rest_mesh.n_vertices() != n)
    throw GeometryError("the rest shape has " + std::to_string(rest_mesh.n_vertices()) + " vertices, the mesh " +
                        std::to_string(n) + "; both must be of one topology");
  Buffer<Vec4f> positions = mesh.positions, moved(n), laplacians(n);
  Buffer<float> strengths(n), ways(n, 0.0F);
  Iteration it{};
  it.topology = mesh.view();
  it.lattice = field.lattice;
  it.field = raw(field.values);
  it.strength = raw(strengths);
  it.way = raw(ways);
  it.tricubic = options.interpolation == Interpolation::kTricubic;
  const double internal = internal_step(options);
  it.step_external = static_cast<float>(options.sigma * options.mu);
  it.step_tension = static_cast<float>(internal * (1 - options.rho));
  it.step_rigidity = static_cast<float>(internal * options.rho);
  {
    it.from = raw(positions);
    const Iteration start = it;
    for_each_index(n, [=] ESPDIFF_HD(std::size_t v) {
      start.strength[v] = field_at(start, start.from[v].xyz()).w > 0 ? -1.0F : 1.0F;
    });
  }
  Vec4f* const laplacian = raw(laplacians);
  it.laplacian = laplacian;
  Buffer<Vec4f> rest_laplacians(n, Vec4f{});
  Vec4f* const rest = raw(rest_laplacians);
  if (options.rest_shape) {
    const TopologyView topology = it.topology;
    const Vec4f* const shape = raw(rest_mesh.positions);
    for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { rest[v] = umbrella(topology, shape, v); });
  }

  DeformReport result;
  while (result.iterations < options.max_iterations && !result.converged) {
    it.from = raw(positions);
    it.to = raw(moved);
    const Iteration now = it;
    for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { laplacian[v] = umbrella(now.topology, now.from, v) - rest[v]; });
    for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { move_vertex(now, v); });
    positions.swap(moved);
    ++result.iterations;
    if (result.iterations % kCheckInterval == 0 || result.iterations == options.max_iterations) {
      const Vec4f* const x = raw(positions);
      result.mean_displacement_A =
          sum_over<double>(n, [=] ESPDIFF_HD(std::size_t v) { return static_cast<double>(x[v].w); }) /
          static_cast<double>(n);
      result.converged = result.mean_displacement_A < options.min_displacement_A;
      progress.report(stage, static_cast<double>(result.iterations) / options.max_iterations);
    }
  }
  progress.report(stage, 1.0);
  if (report != nullptr) {
    auto path_length = std::make_shared<Scalars>();
    path_length->values = std::move(ways);
    result.path_length = path_length;
    *report = result;
  }
  auto deformed = std::make_shared<SurfaceMesh>();
  deformed->topology = mesh.topology;
  deformed->positions = std::move(positions);
  return deformed;
}

}  // namespace espdiff::ESPDIFF_BACKEND
