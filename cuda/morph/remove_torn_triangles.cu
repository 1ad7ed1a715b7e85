// remove_torn_triangles.cu: finds torn or crushed parts of the surface by comparing normals with the density's
// gradient.
#include "cuda/morph/remove_torn_triangles.h"

#include "cuda/morph/moving_surface.h"

namespace espdiff::ESPDIFF_BACKEND {

void remove_torn_triangles(MovingSurface& surface) {
  const MovingSurfaceView s = view_of(surface);
  // The corners of a triangle share its area vector; in w, whether it is flipped.
  Buffer<Vec4f> area_vectors(surface.removed.size());
  Vec4f* const area = raw(area_vectors);
  for_each_index(surface.removed.size(), [=] ESPDIFF_HD(std::size_t t) {
    const Corners c = s.topology.triangles[t];
    if (all_wait(s, c)) {
      area[t].w = 0.0F;
      return;
    }
    const Vec3f uphill = s.gradient[c.v[0]].xyz() + s.gradient[c.v[1]].xyz() + s.gradient[c.v[2]].xyz();
    const Vec3f normal = twice_area_vector(s.x, c);
    area[t] = make_vec4(normal, dot(normal, uphill) >= 0 ? 1.0F : 0.0F);
  });
  for_each_index(surface.x.size(), [=] ESPDIFF_HD(std::size_t v) {
    if (s.unmatched[v] != 0 || s.waits[v] != 0) return;
    Vec3f normal{};
    bool any = false;
    for (std::uint32_t n = s.topology.first[v]; n < s.topology.first[v + 1]; ++n) {
      const std::uint32_t t = s.topology.incident[n];
      if (s.removed[t] != 0) continue;
      any = true;
      normal += area[t].xyz();
    }
    if (!any || dot(normal, s.gradient[v].xyz()) > 0) s.unmatched[v] = 1;
  });
  for_each_index(surface.removed.size(), [=] ESPDIFF_HD(std::size_t t) {
    if (s.removed[t] != 0) return;
    const Corners c = s.topology.triangles[t];
    const bool unmatched = s.unmatched[c.v[0]] != 0 || s.unmatched[c.v[1]] != 0 || s.unmatched[c.v[2]] != 0;
    if (unmatched || area[t].w != 0) s.removed[t] = 1;
  });
}

}  // namespace espdiff::ESPDIFF_BACKEND
