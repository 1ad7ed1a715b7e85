// smooth_tangentially.cu: improves badly shaped triangles of the moving surface and leaves the others alone.
#include "cuda/morph/smooth_tangentially.h"

#include "cuda/morph/moving_surface.h"
#include "cuda/surface/mesh/adjacency.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// A vertex moves only where a triangle's quality is below this fraction of its quality on the source, so that rigid
/// motion changes nothing.
constexpr float kKeptQuality = 0.4F;
/// Largest fraction of the distance to the mean of the ring.
constexpr float kPace = 0.5F;

/// 1 for an equilateral triangle, 0 for one without area.
ESPDIFF_INLINE float shape_quality(const Vec4f* x, const Corners& c) {
  const Vec3f ab = x[c.v[1]].xyz() - x[c.v[0]].xyz(), bc = x[c.v[2]].xyz() - x[c.v[1]].xyz(),
              ca = x[c.v[0]].xyz() - x[c.v[2]].xyz();
  const float squares = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
  return squares > 0 ? 3.4641016F * norm(cross(ab, ca)) / squares : 0.0F;
}

/// Smallest altitude of a triangle.
ESPDIFF_INLINE float least_altitude(const Vec4f* x, const Corners& c) {
  const Vec3f ab = x[c.v[1]].xyz() - x[c.v[0]].xyz(), bc = x[c.v[2]].xyz() - x[c.v[1]].xyz(),
              ca = x[c.v[0]].xyz() - x[c.v[2]].xyz();
  const float longest = sqrtf(larger(dot(ab, ab), larger(dot(bc, bc), dot(ca, ca))));
  return longest > 0 ? norm(cross(ab, ca)) / longest : 0.0F;
}

}  // namespace

void smooth_tangentially(MovingSurface& surface) {
  Buffer<Vec4f> smoothed(surface.n_vertices());
  Buffer<float> qualities(surface.n_triangles());
  const MovingSurfaceView s = view_of(surface);
  Vec4f* const to = raw(smoothed);
  float* const quality = raw(qualities);
  for_each_index(surface.n_triangles(), [=] ESPDIFF_HD(std::size_t t) {
    const Corners c = s.topology.triangles[t];
    if (!all_wait(s, c)) quality[t] = shape_quality(s.x, c);
  });
  for_each_index(surface.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    to[v] = s.x[v];
    if (s.unmatched[v] != 0 || s.waits[v] != 0) return;
    float now = 1.0F, before = 1.0F, altitude = 1e30F;
    for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n)
      now = smaller(now, quality[s.topology.incident[n]]);
    if (now >= kKeptQuality) return;  // whatever it was on the source
    for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n) {
      const std::uint32_t t = s.topology.incident[n];
      if (s.removed[t] != 0) return;  // at a border
      before = smaller(before, shape_quality(s.source, s.topology.triangles[t]));
      altitude = smaller(altitude, least_altitude(s.x, s.topology.triangles[t]));
    }
    const float need = 1.0F - now / (kKeptQuality * before);
    if (!(need > 0)) return;
    Vec3f move = (kPace * smaller(1.0F, 2.0F * need)) * umbrella(s.topology, s.x, v).xyz();
    const Vec3f gradient = s.gradient[v].xyz();
    move = move - (dot(move, gradient) / dot(gradient, gradient)) * gradient;
    const float length = norm(move), most = altitude / 3.0F;
    if (length > most) move = (most / length) * move;
    to[v] = make_vec4(s.x[v].xyz() + move, s.x[v].w + norm(move));
  });
  surface.x.swap(smoothed);
}

}  // namespace espdiff::ESPDIFF_BACKEND
