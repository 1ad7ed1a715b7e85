// deform.cu: the force iteration in two passes: umbrella Laplacians, then forces and the move.
#include "cuda/deform/deform.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/deform/deform_graph.h"
#include "cuda/deform/deform_iteration.h"
#include "engine/deform_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// The eigenvalues of the umbrella operator lie in [-2, 0], so an explicit step along (1 - rho) L - rho L^2 is stable
/// for every rho if it is below 2 / 4.
constexpr double kLargestInternalStep = 0.5;

double internal_step(const DeformOptions& o) { return o.sigma * (1 - o.mu) * o.tangential_gain; }

void check_options(const DeformOptions& o) {
  if (!(o.sigma > 0)) throw InputError("sigma " + formatted(o.sigma) + " is not positive; 0.1 is usual");
  if (!(o.mu >= 0 && o.mu <= 1)) throw InputError("mu " + formatted(o.mu) + " is not between 0 and 1");
  if (!(o.rho >= 0 && o.rho <= 1)) throw InputError("rho " + formatted(o.rho) + " is not between 0 and 1");
  if (!(o.tangential_gain >= 0))
    throw InputError("the tangential gain, " + formatted(o.tangential_gain) +
                     ", is negative; 1 is the plain iteration");
  if (!(o.momentum >= 0 && o.momentum < 1))
    throw InputError("the momentum, " + formatted(o.momentum) + ", is not from 0 to below 1; 0.7 is usual");
  if (internal_step(o) > kLargestInternalStep) {
    throw InputError("sigma (1 - mu) times the tangential gain is " + formatted(internal_step(o)) + ", beyond " +
                     formatted(kLargestInternalStep) + " where the iteration becomes unstable; lower one of them");
  }
  if (o.max_iterations < 0)
    throw InputError("the number of iterations, " + std::to_string(o.max_iterations) + ", is negative");
  if (!(o.min_displacement_A >= 0))
    throw InputError("the smallest displacement, " + formatted(o.min_displacement_A) + " A, is negative");
}

#if !defined(__CUDACC__)

ESPDIFF_MULTIVERSION void take_laplacians(const Iteration& it, std::size_t begin, std::size_t end) {
  for (std::size_t v = begin; v < end; ++v) take_laplacian(it, v);
}

constexpr std::size_t kVertexLanes = 32;

/// What kVertexLanes vertices read before they move: [lane].
struct LaneReading {
  const Vec4f* cell[kVertexLanes];  ///< of the field: the lowest corner
  float part[3][kVertexLanes];      ///< 0 to 1 within the cell
  alignas(16) float field[kVertexLanes][4], laplacian_squared[kVertexLanes][4];
};

/// The cells of vertices from `begin` on, by locate().
ESPDIFF_INLINE void locate_lanes(const Iteration& it, std::size_t begin, LaneReading& r) {
  std::int32_t base[3][kVertexLanes];
  const float inverse_spacing = 1.0F / it.lattice.spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const float* const x = reinterpret_cast<const float*>(it.from + begin) + axis;
    const float origin = it.lattice.origin[axis], highest = static_cast<float>(it.lattice.size[axis] - 1);
    const std::int32_t last = it.lattice.size[axis] - 2;
    for (std::size_t i = 0; i < kVertexLanes; ++i) {
      const float c = smaller(larger((x[4 * i] - origin) * inverse_spacing, 0.0F), highest);
      const std::int32_t cell = static_cast<std::int32_t>(c);
      base[axis][i] = cell > last ? last : cell;
      r.part[axis][i] = c - static_cast<float>(base[axis][i]);
    }
  }
  for (std::size_t i = 0; i < kVertexLanes; ++i)
    r.cell[i] = it.field + it.lattice.index(base[0][i], base[1][i], base[2][i]);
}

/// move_vertex() for kVertexLanes vertices, step by step, with the same bits; the field is interpolated linearly.
/// @param r    from locate_lanes()
/// @param next of the vertices that move next, whose cells are fetched; may be those of `r`
ESPDIFF_INLINE void move_lanes(const Iteration& it, std::size_t begin, LaneReading& r, const LaneReading& next) {
  const std::size_t nx = static_cast<std::size_t>(it.lattice.size[0]),
                    nxy = nx * static_cast<std::size_t>(it.lattice.size[1]);
  // Without it a fifth of the time would be waiting for the field.
  constexpr std::size_t kAhead = 12;
  for (std::size_t i = 0; i < kVertexLanes; ++i) {
    const Vec4f* const cell = i + kAhead < kVertexLanes ? r.cell[i + kAhead] : next.cell[i + kAhead - kVertexLanes];
    for (const std::size_t row : {std::size_t{0}, nx, nxy, nxy + nx}) __builtin_prefetch(cell + row);
    const Quad squared = umbrella_quad(it.topology, it.laplacian, begin + i),
               field = mix_cell(r.cell[i], nx, nxy, r.part[0][i], r.part[1][i], r.part[2][i]);
    std::memcpy(r.laplacian_squared[i], &squared, sizeof squared);
    std::memcpy(r.field[i], &field, sizeof field);
  }
  const Vec4f *const from = it.from + begin, *const laplacian = it.laplacian + begin;
  Vec4f* const to = it.to + begin;
  float *const strength = it.strength + begin, *const path_length = it.path_length + begin;
  const std::uint32_t* const first = it.topology.first + begin;
  // What is written is not read by another lane.
#pragma GCC ivdep
  for (std::size_t i = 0; i < kVertexLanes; ++i) {
    const float x = it.step_tension * laplacian[i].x - it.step_rigidity * r.laplacian_squared[i][0] +
                    it.momentum * (from[i].x - to[i].x),
                y = it.step_tension * laplacian[i].y - it.step_rigidity * r.laplacian_squared[i][1] +
                    it.momentum * (from[i].y - to[i].y),
                z = it.step_tension * laplacian[i].z - it.step_rigidity * r.laplacian_squared[i][2] +
                    it.momentum * (from[i].z - to[i].z);
    const float old = strength[i];
    const float s = (r.field[i][3] > 0) == (old > 0) ? old * -0.5F : old;
    strength[i] = s;
    const float fx = r.field[i][0], fy = r.field[i][1], fz = r.field[i][2];
    const float length = std::sqrt(fx * fx + fy * fy + fz * fz), inverse = 1.0F / length;
    const float ux = inverse * fx, uy = inverse * fy, uz = inverse * fz;
    const float along = it.step_external * s - (x * ux + y * uy + z * uz);
    const bool pulled = (length > 1e-12F) & (first[i + 1] > first[i]);
    const float mx = pulled ? x + along * ux : x, my = pulled ? y + along * uy : y, mz = pulled ? z + along * uz : z;
    const float distance = std::sqrt(mx * mx + my * my + mz * mz);
    path_length[i] += distance;
    to[i] = {from[i].x + mx, from[i].y + my, from[i].z + mz, distance};
  }
}

ESPDIFF_MULTIVERSION void move_vertices(const Iteration& it, std::size_t begin, std::size_t end) {
  std::size_t v = begin;
  if (!it.tricubic && v + kVertexLanes <= end) {
    LaneReading readings[2];
    locate_lanes(it, v, readings[0]);
    for (std::size_t k = 0; v + kVertexLanes <= end; v += kVertexLanes, k = 1 - k) {
      const bool is_last = v + 2 * kVertexLanes > end;
      if (!is_last) locate_lanes(it, v + kVertexLanes, readings[1 - k]);
      move_lanes(it, v, readings[k], readings[is_last ? k : 1 - k]);
    }
  }
  for (; v < end; ++v) move_vertex(it, v);
}

void iterate_once(const Iteration& now, std::size_t n) {
  constexpr std::size_t kVerticesPerCall = 256;
  const std::size_t n_calls = (n + kVerticesPerCall - 1) / kVerticesPerCall;
  const auto end_of = [=](std::size_t call) { return std::min((call + 1) * kVerticesPerCall, n); };
  for_each_index(n_calls, [=](std::size_t call) { take_laplacians(now, call * kVerticesPerCall, end_of(call)); });
  for_each_index(n_calls, [=](std::size_t call) { move_vertices(now, call * kVerticesPerCall, end_of(call)); });
}

#else

void iterate_once(const Iteration& now, std::size_t n) {
  for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { take_laplacian(now, v); });
  for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { move_vertex(now, v); });
}

#endif

}  // namespace

void set_steps(Iteration& it, const DeformOptions& options) {
  const double internal = internal_step(options);
  it.step_external = static_cast<float>(options.sigma * options.mu);
  it.step_tension = static_cast<float>(internal * (1 - options.rho));
  it.step_rigidity = static_cast<float>(internal * options.rho);
  it.momentum = static_cast<float>(options.momentum);
}

void iterate_one_by_one(DeformState& state, const DeformOptions& options, const std::string& stage,
                        const Progress& progress, DeformReport& report) {
  const std::size_t n = state.positions.size();
  while (report.iterations < options.max_iterations && !report.converged) {
    Iteration now = state.iteration;
    now.from = raw(state.positions);
    now.to = raw(state.moved);
    iterate_once(now, n);
    state.positions.swap(state.moved);
    ++report.iterations;
    if (report.iterations % kCheckInterval == 0 || report.iterations == options.max_iterations) {
      const Vec4f* const x = raw(state.positions);
      report.mean_displacement_A =
          sum_over<double>(n, [=] ESPDIFF_HD(std::size_t v) { return static_cast<double>(x[v].w); }) /
          static_cast<double>(n);
      report.converged = report.mean_displacement_A < options.min_displacement_A;
      progress.report(stage, static_cast<double>(report.iterations) / options.max_iterations);
    }
  }
}

std::shared_ptr<SurfaceMesh> deform(const SurfaceMesh& mesh, const SurfaceMesh& rest_mesh, const SurfaceField& field,
                                    const DeformOptions& options, const std::string& stage, const Progress& progress,
                                    DeformReport* report) {
  check_options(options);
  const std::size_t n = mesh.n_vertices();
  if (rest_mesh.n_vertices() != n)
    throw GeometryError("the rest shape has " + std::to_string(rest_mesh.n_vertices()) + " vertices, the mesh " +
                        std::to_string(n) + "; both must be of one topology");
  DeformState state;
  state.positions = mesh.positions;
  state.moved = mesh.positions;
  Buffer<Vec4f> laplacians(n), rest_laplacians(options.rest_shape ? n : 0);
  Buffer<float> strengths(n), path_lengths(n, 0.0F);
  Iteration& it = state.iteration;
  it.topology = mesh.view();
  it.lattice = field.lattice;
  it.field = raw(field.values);
  it.strength = raw(strengths);
  it.path_length = raw(path_lengths);
  it.laplacian = raw(laplacians);
  it.rest = options.rest_shape ? raw(rest_laplacians) : nullptr;
  it.tricubic = options.interpolation == Interpolation::kTricubic;
  set_steps(it, options);
  it.from = raw(state.positions);
  const Iteration start = it;
  for_each_index(n, [=] ESPDIFF_HD(std::size_t v) {
    start.strength[v] = field_at(start, start.from[v].xyz()).w > 0 ? -1.0F : 1.0F;
  });
  if (options.rest_shape) {
    const Vec4f* const shape = raw(rest_mesh.positions);
    Vec4f* const rest = raw(rest_laplacians);
    for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { rest[v] = umbrella(start.topology, shape, v); });
  }

  DeformReport result;
#if defined(ESPDIFF_BACKEND_CUDA)
  iterate_in_graphs(state, options, stage, progress, result);
#else
  iterate_one_by_one(state, options, stage, progress, result);
#endif
  progress.report(stage, 1.0);
  if (report != nullptr) {
    auto path_length = std::make_shared<Scalars>();
    path_length->values = std::move(path_lengths);
    result.path_length = path_length;
    *report = result;
  }
  auto deformed = std::make_shared<SurfaceMesh>();
  deformed->topology = mesh.topology;
  deformed->positions = std::move(state.positions);
  return deformed;
}

}  // namespace espdiff::ESPDIFF_BACKEND
