// follow_level_set.cu: moves vertices with the atoms' velocity, then back onto the level set by Newton's method.
#include "cuda/device/spatial_order.h"
#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr int kMaxNewtonSteps = 4;
/// With a smaller density error than this, the next Newton step is the last.
constexpr float kLastStepExcess = 0.03F;
/// A vertex with a larger density error than this after the last step is unmatched.
constexpr float kUnmatchedExcess = 0.1F;
/// A vertex that Newton's method moves farther than this in one time step has left its sheet of the surface.
constexpr float kMaxShift_A = 0.6F;
/// Limit of the predicted shift of the level set per step: where the slope is small, the prediction is a guess.
constexpr float kMaxPrediction_A = 0.5F;

}  // namespace

// Second order in time for the atoms' part (Adams-Bashforth): one evaluation a step.
void advance(MovingSurface& surface, float dt) {
  const MovingSurfaceView s = view_of(surface);
  for_each_index(surface.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec4f flow = s.flow[v], before = s.previous[v];
    Vec3f move = dt * (1.5F * flow.xyz() - 0.5F * before.xyz());
    const Vec3f gradient = s.gradient[v].xyz();
    const float slope = norm(gradient);
    if (s.unmatched[v] == 0 && slope > kLeastSlope) {
      const float along = smaller(larger(dt * flow.w, -kMaxPrediction_A), kMaxPrediction_A);
      move += (along / slope) * gradient;
    }
    s.x[v] = make_vec4(s.x[v].xyz() + move, s.x[v].w + norm(move));
    s.previous[v] = flow;
  });
}

// Converged vertices leave the list, so all passes but the first are short.
void return_to_level_set(MovingSurface& surface, const MovingAtoms& atoms, float isovalue) {
  const MovingSurfaceView s = view_of(surface);
  const std::size_t n = surface.x.size();
  Buffer<FlowSample> sampled(n);
  const Buffer<Vec4f> before = surface.x;
  const FlowSample* const samples = raw(sampled);
  const Vec4f* const start = raw(before);
  Buffer<std::uint32_t> pending = surface.order;
  Buffer<std::uint8_t> done_flags(n, 0);
  std::uint8_t* const done = raw(done_flags);
  std::size_t n_pending = n;
  for (int step = 0; n_pending > 0 && step <= kMaxNewtonSteps; ++step) {
    flow_at_points(atoms, surface.x, pending, n_pending, sampled);
    const std::uint32_t* const list = raw(pending);
    const bool last = step == kMaxNewtonSteps;
    for_each_index(n_pending, [=] ESPDIFF_HD(std::size_t i) {
      const std::uint32_t v = list[i];
      const FlowSample sample = samples[v];
      const float excess = sample.density - isovalue;
      const float square = dot(sample.gradient, sample.gradient);
      const float slope = larger(sqrtf(square), kLeastSlope);
      s.gradient[v] = make_vec4(sample.gradient, sample.density);
      s.flow[v] = make_vec4(sample.velocity, -(sample.rate + dot(sample.gradient, sample.velocity)) / slope);
      done[v] = 1;
      if (s.unmatched[v] != 0) return;
      Vec3f shift = (-excess / (slope * slope)) * sample.gradient;
      const float length = norm(shift);
      if (length > 0.5F * kMaxShift_A) shift = (0.5F * kMaxShift_A / length) * shift;
      const Vec3f moved = s.x[v].xyz() + shift;
      const bool broken = !(square > kLeastSlope * kLeastSlope) || norm(moved - start[v].xyz()) > kMaxShift_A ||
                          (last && fabsf(excess) > kUnmatchedExcess);
      s.unmatched[v] = broken ? 1 : 0;
      s.x[v] = broken ? start[v] : make_vec4(moved, s.x[v].w + norm(shift));
      if (!broken && fabsf(excess) >= kLastStepExcess) done[v] = 0;
    });
    n_pending = drop_done(pending, n_pending, done_flags);
  }
}

}  // namespace espdiff::ESPDIFF_BACKEND
