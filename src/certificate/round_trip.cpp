// round_trip.cpp: composes two mappings and sums the distances, weighted by the source's area.
#include "certificate/round_trip.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "engine/engine.h"

namespace espdiff {

RoundTrip measure_round_trip(Engine& engine, const Mapping& there, const Mapping& back) {
  // Points that the mapping back has lost have no end.
  constexpr double kOnSurface_A = 0.5;
  const MeshPtr returned = engine.carry(there.matched, back.matched_source, back.matched, kOnSurface_A);
  const std::vector<float> distances = engine.download(engine.displacement(there.matched_source, returned));
  const Mesh source = engine.download_shape(there.matched_source);
  std::vector<double> weights(distances.size(), 0.0);
  for (const Triangle& t : source.triangles) {
    const Vec3d a = static_cast<Vec3d>(source.positions[t[0]]), b = static_cast<Vec3d>(source.positions[t[1]]),
                c = static_cast<Vec3d>(source.positions[t[2]]);
    for (const std::uint32_t v : t) weights[v] += norm(cross(b - a, c - a)) / 6;
  }
  std::vector<std::pair<double, double>> by_distance;
  double area = 0, sum = 0;
  for (std::size_t v = 0; v < distances.size(); ++v) {
    if (!std::isfinite(distances[v])) continue;
    by_distance.emplace_back(static_cast<double>(distances[v]), weights[v]);
    area += weights[v];
    sum += weights[v] * static_cast<double>(distances[v]);
  }
  if (by_distance.empty()) throw GeometryError("round trip: no point of the surface can be mapped back");
  std::sort(by_distance.begin(), by_distance.end());
  RoundTrip trip;
  trip.mean_A = sum / area;
  trip.max_A = by_distance.back().first;
  double below = 0;
  for (const auto& [distance, weight] : by_distance) {
    below += weight;
    trip.p95_A = distance;
    if (below >= 0.95 * area) break;
  }
  trip.unmatched_target_area_fraction = 1 - engine.area(back.matched_source) / engine.area(back.source);
  return trip;
}

}  // namespace espdiff
