// project.cu: projects vertices onto the analytic isosurface by Newton's method.
#include "cuda/surface/project.h"

#include "cuda/device/spatial_order.h"
#include "cuda/surface/density/density_sums.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr int kMaxNewtonSteps = 6;
/// Within this fraction of the isovalue, one more step reaches it to 1e-4: Newton's error is the square of this times
/// the curvature.
constexpr float kLastStepShare = 0.008F;
/// Longest step as a fraction of the largest shift: over longer distances the density is far from linear.
constexpr float kStepShare = 0.5F;

/// The vertices that are projected.
struct Projection {
  const Vec4f* start;
  Vec4f* x;
  float isovalue, max_shift_A;
  std::size_t first;  // vertices before it stay
};

/// One step of Newton's method at a vertex.
/// @returns whether it was the last
ESPDIFF_INLINE bool newton_step(const Projection& in, std::size_t v, const DensitySample& sample) {
  const float excess = sample.value - in.isovalue;
  const float slope_squared = dot(sample.gradient, sample.gradient);
  Vec3f shift = (-excess / larger(slope_squared, 1e-12F)) * sample.gradient;
  const float length = norm(shift);
  if (length > kStepShare * in.max_shift_A) shift = (kStepShare * in.max_shift_A / length) * shift;
  const Vec3f moved = in.x[v].xyz() + shift;
  const bool stays = !(slope_squared > 1e-12F) || norm(moved - in.start[v].xyz()) > in.max_shift_A;
  in.x[v] = make_vec4(stays ? in.start[v].xyz() : moved, 0.0F);
  return stays || fabsf(excess) < kLastStepShare * in.isovalue;
}

/// The general form: each vertex takes all its steps.
void vertex_by_vertex(const Projection& in, const AtomCells& atoms, const Buffer<std::uint32_t>& order) {
  const AtomCellsView cells = atoms.view();
  const std::uint32_t* const list = raw(order);
  for_each_index(order.size(), [=] ESPDIFF_HD(std::size_t i) {
    const std::uint32_t v = list[i];
    if (v < in.first) return;
    for (int step = 0; step < kMaxNewtonSteps; ++step) {
      if (newton_step(in, v, density_at(cells, in.x[v].xyz()))) return;
    }
  });
}

#if !defined(__CUDACC__)

/// Step by step, in blocks of vertices; converged ones leave the list.
void step_by_step(const Projection& in, const AtomCells& atoms, const Buffer<Vec4f>& positions,
                  Buffer<std::uint32_t> pending) {
  const std::size_t n = positions.size();
  Buffer<DensitySample> sampled(n);
  Buffer<std::uint8_t> done_flags(n, 0);
  const DensitySample* const samples = raw(sampled);
  std::uint8_t* const done = raw(done_flags);
  std::size_t n_pending = n;
  if (in.first > 0) {
    const std::size_t first = in.first;
    for_each_index(n, [=](std::size_t v) { done[v] = v < first ? 1 : 0; });
    n_pending = drop_done(pending, n_pending, done_flags);
  }
  for (int step = 0; n_pending > 0 && step < kMaxNewtonSteps; ++step) {
    density_at_points(atoms, positions, pending, n_pending, sampled);
    const std::uint32_t* const list = raw(pending);
    for_each_index(n_pending, [=](std::size_t i) {
      const std::uint32_t v = list[i];
      done[v] = newton_step(in, v, samples[v]) ? 1 : 0;
    });
    n_pending = drop_done(pending, n_pending, done_flags);
  }
}

#endif

std::shared_ptr<SurfaceMesh> project_in_form(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue,
                                             float max_shift_A, std::size_t first, bool by_blocks) {
  auto result = std::make_shared<SurfaceMesh>();
  result->topology = mesh.topology;
  result->positions = mesh.positions;
  const Projection in{raw(mesh.positions), raw(result->positions), isovalue, max_shift_A, first};
  Vec4f* const x = in.x;
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) { x[v].w = 0.0F; });
#if !defined(__CUDACC__)
  if (by_blocks) {
    step_by_step(in, atoms, result->positions, spatial_order(mesh.positions));
    return result;
  }
#else
  static_cast<void>(by_blocks);
#endif
  vertex_by_vertex(in, atoms, spatial_order(mesh.positions));
  return result;
}

}  // namespace

std::shared_ptr<SurfaceMesh> project(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue, float max_shift_A,
                                     std::size_t first) {
  return project_in_form(mesh, atoms, isovalue, max_shift_A, first, true);
}

std::shared_ptr<SurfaceMesh> project_vertex_by_vertex(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue,
                                                      float max_shift_A, std::size_t first) {
  return project_in_form(mesh, atoms, isovalue, max_shift_A, first, false);
}

}  // namespace espdiff::ESPDIFF_BACKEND
