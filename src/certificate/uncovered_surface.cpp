// uncovered_surface.cpp: picks the uncovered triangles and five rings of neighbours.
#include "certificate/uncovered_surface.h"

#include <limits>

namespace espdiff {

UncoveredSurface uncovered_surface(const Mesh& target, const std::vector<float>& beyond,
                                   const RigidTransform& to_target) {
  constexpr int kRings = 5;
  std::vector<std::uint8_t> is_near(target.positions.size(), 0);
  for (std::size_t t = 0; t < target.triangles.size(); ++t) {
    if (beyond[t] == 0) continue;
    for (const std::uint32_t v : target.triangles[t]) is_near[v] = 1;
  }
  for (int ring = 0; ring < kRings; ++ring) {
    std::vector<std::uint8_t> next = is_near;
    for (const Triangle& t : target.triangles) {
      if (is_near[t[0]] + is_near[t[1]] + is_near[t[2]] == 0) continue;
      for (const std::uint32_t v : t) next[v] = 1;
    }
    is_near.swap(next);
  }
  constexpr std::uint32_t kAbsent = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(target.positions.size(), kAbsent);
  UncoveredSurface result;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (is_near[v] == 0) continue;
    place[v] = static_cast<std::uint32_t>(result.positions.size());
    result.positions.push_back(to_target.apply(static_cast<Vec3d>(target.positions[v])));
    result.normals.push_back(static_cast<Vec3f>(to_target.rotate(static_cast<Vec3d>(target.normals[v]))));
  }
  for (std::size_t t = 0; t < target.triangles.size(); ++t) {
    const Triangle& from = target.triangles[t];
    const Triangle to{place[from[0]], place[from[1]], place[from[2]]};
    if (to[0] == kAbsent || to[1] == kAbsent || to[2] == kAbsent) continue;
    result.triangles.push_back(to);
    result.uncovered.push_back(beyond[t] != 0 ? 1 : 0);
  }
  return result;
}

}  // namespace espdiff
