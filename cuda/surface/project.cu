// project.cu: projects vertices onto the analytic isosurface by Newton's method.
#include "cuda/surface/project.h"

#include "cuda/device/spatial_order.h"
#include "cuda/surface/density_at_points.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr int kMaxNewtonSteps = 6;
/// Within this fraction of the isovalue, one more step reaches it to 1e-4: Newton's error is the square of this times
/// the curvature.
constexpr float kLastStepShare = 0.008F;
/// Longest step as a fraction of the largest shift: over longer distances the density is far from linear.
constexpr float kStepShare = 0.5F;

}  // namespace

// Converged vertices leave the list.
std::shared_ptr<SurfaceMesh> project(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue,
                                     float max_shift_A) {
  const std::size_t n = mesh.n_vertices();
  auto result = std::make_shared<SurfaceMesh>();
  result->topology = mesh.topology;
  result->positions = mesh.positions;
  Buffer<DensitySample> sampled(n);
  Buffer<std::uint8_t> done_flags(n, 0);
  Buffer<std::uint32_t> pending = spatial_order(mesh.positions);
  const Vec4f* const start = raw(mesh.positions);
  const DensitySample* const samples = raw(sampled);
  Vec4f* const x = raw(result->positions);
  std::uint8_t* const done = raw(done_flags);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { x[v].w = 0.0F; });
  std::size_t n_pending = n;
  for (int step = 0; n_pending > 0 && step < kMaxNewtonSteps; ++step) {
    density_at_points(atoms, result->positions, pending, n_pending, sampled);
    const std::uint32_t* const list = raw(pending);
    for_each_index(n_pending, [=] ESPDIFF_HD(std::size_t i) {
      const std::uint32_t v = list[i];
      const DensitySample sample = samples[v];
      const float excess = sample.value - isovalue;
      const float slope_squared = dot(sample.gradient, sample.gradient);
      Vec3f shift = (-excess / larger(slope_squared, 1e-12F)) * sample.gradient;
      const float length = norm(shift);
      if (length > kStepShare * max_shift_A) shift = (kStepShare * max_shift_A / length) * shift;
      const Vec3f moved = x[v].xyz() + shift;
      const bool stays = !(slope_squared > 1e-12F) || norm(moved - start[v].xyz()) > max_shift_A;
      x[v] = make_vec4(stays ? start[v].xyz() : moved, 0.0F);
      done[v] = stays || fabsf(excess) < kLastStepShare * isovalue ? 1 : 0;
    });
    n_pending = drop_done(pending, n_pending, done_flags);
  }
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
