// follow_level_set.cu: moves vertices with the atoms' velocity, then back onto the level set by Newton's method.
#include "cuda/morph/follow_level_set.h"

#include "cuda/device/spatial_order.h"
#include "cuda/morph/flow_sums.h"
#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr int kMaxReturnSteps = 4;
/// With a smaller density error than this, the next Newton step is the last.
constexpr float kLastStepExcess = 0.03F;
/// A vertex with a larger density error than this after the last step is unmatched.
constexpr float kUnmatchedExcess = 0.1F;
/// A vertex that Newton's method moves farther than this in one time step has left its sheet of the surface.
constexpr float kMaxShift_A = 0.6F;
/// Limit of the predicted shift of the level set per step: where the slope is small, the prediction is a guess.
constexpr float kMaxPrediction_A = 0.5F;

}  // namespace

// Second order in time for the atoms' part (Adams-Bashforth): the flow in the middle of the step on the line through
// the last two evaluations.
void advance(MovingSurface& surface, std::uint32_t step, float dt) {
  const MovingSurfaceView s = view_of(surface);
  for_each_index(surface.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec4f flow = s.flow[v], before = s.previous[v];
    const VertexClock clock = s.clock[v];
    const float ahead = (static_cast<float>(step - clock.last) - 0.5F) / static_cast<float>(clock.previous_interval);
    Vec3f move = dt * (flow.xyz() + ahead * (flow.xyz() - before.xyz()));
    const Vec3f gradient = s.gradient[v].xyz();
    const float slope = norm(gradient);
    if (s.unmatched[v] == 0 && slope > kLeastSlope) {
      const float along = smaller(larger(dt * flow.w, -kMaxPrediction_A), kMaxPrediction_A);
      move += (along / slope) * gradient;
    }
    s.x[v] = make_vec4(s.x[v].xyz() + move, s.x[v].w + norm(move));
  });
}

namespace {

/// The vertices that return to the level set.
struct ReturningVertices {
  MovingSurfaceView surface;
  const Vec4f* start;
  float isovalue;
};

/// One step of Newton's method at a vertex.
/// @param last whether no other step follows
/// @returns whether the vertex needs none
ESPDIFF_INLINE bool return_step(const ReturningVertices& in, std::size_t v, const FlowSample& sample, bool last) {
  const MovingSurfaceView& s = in.surface;
  const float excess = sample.density - in.isovalue;
  const float square = dot(sample.gradient, sample.gradient);
  const float slope = larger(sqrtf(square), kLeastSlope);
  s.gradient[v] = make_vec4(sample.gradient, sample.density);
  s.flow[v] = make_vec4(sample.velocity, -(sample.rate + dot(sample.gradient, sample.velocity)) / slope);
  if (s.unmatched[v] != 0) return true;
  Vec3f shift = (-excess / (slope * slope)) * sample.gradient;
  const float length = norm(shift);
  if (length > 0.5F * kMaxShift_A) shift = (0.5F * kMaxShift_A / length) * shift;
  const Vec3f moved = s.x[v].xyz() + shift;
  const bool broken = !(square > kLeastSlope * kLeastSlope) || norm(moved - in.start[v].xyz()) > kMaxShift_A ||
                      (last && fabsf(excess) > kUnmatchedExcess);
  s.unmatched[v] = broken ? 1 : 0;
  s.x[v] = broken ? in.start[v] : make_vec4(moved, s.x[v].w + norm(shift));
  return broken || fabsf(excess) < kLastStepExcess;
}

}  // namespace

void return_vertex_by_vertex(MovingSurface& surface, const MovingAtoms& atoms, float isovalue) {
  const Buffer<Vec4f> before = surface.x;
  const ReturningVertices in{view_of(surface), raw(before), isovalue};
  const AtomCellsView cells = atoms.cells->view();
  const AtomChange* const changes = raw(atoms.change);
  const std::uint32_t* const list = raw(surface.order);
  for_each_index(surface.x.size(), [=] ESPDIFF_HD(std::size_t i) {
    const std::uint32_t v = list[i];
    if (in.surface.waits[v] != 0) return;
    for (int step = 0; step <= kMaxReturnSteps; ++step) {
      const FlowSample sample = flow_at(cells, changes, in.surface.x[v].xyz());
      if (return_step(in, v, sample, step == kMaxReturnSteps)) return;
    }
  });
}

void return_to_level_set(MovingSurface& surface, const MovingAtoms& atoms, float isovalue) {
#if defined(__CUDACC__)
  return_vertex_by_vertex(surface, atoms, isovalue);
#else
  // Converged vertices leave the list, so all passes but the first are short.
  const std::size_t n = surface.x.size();
  Buffer<FlowSample> sampled(n);
  const Buffer<Vec4f> before = surface.x;
  const ReturningVertices in{view_of(surface), raw(before), isovalue};
  const FlowSample* const samples = raw(sampled);
  Buffer<std::uint32_t> pending = surface.order;
  Buffer<std::uint8_t> done_flags = surface.waits;
  std::uint8_t* const done = raw(done_flags);
  std::size_t n_pending = drop_done(pending, n, done_flags);
  for (int step = 0; n_pending > 0 && step <= kMaxReturnSteps; ++step) {
    flow_at_points(atoms, surface.x, pending, n_pending, sampled);
    const std::uint32_t* const list = raw(pending);
    const bool last = step == kMaxReturnSteps;
    for_each_index(n_pending, [=](std::size_t i) {
      const std::uint32_t v = list[i];
      done[v] = return_step(in, v, samples[v], last) ? 1 : 0;
    });
    n_pending = drop_done(pending, n_pending, done_flags);
  }
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
