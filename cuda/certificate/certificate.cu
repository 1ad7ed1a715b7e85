// certificate.cu: measures a mapped mesh against the target's density and surface.
#include "cuda/certificate/certificate.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "cuda/certificate/weighted_order.h"
#include "cuda/device/spatial_order.h"
#include "cuda/device/unwrap.h"
#include "cuda/surface/density/density_at_points.h"
#include "cuda/surface/distances_to_triangles.h"
#include "cuda/surface/mesh/adjacency.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

struct FitSums {
  double area = 0, corrupt = 0, flipped = 0;

  ESPDIFF_HD FitSums& operator+=(const FitSums& o) {
    area += o.area;
    corrupt += o.corrupt;
    flipped += o.flipped;
    return *this;
  }
};

struct UmbrellaSum {
  double length = 0, n = 0;

  ESPDIFF_HD UmbrellaSum& operator+=(const UmbrellaSum& o) {
    length += o.length;
    n += o.n;
    return *this;
  }
};

/// Whether triangles surround the vertex. At the border of removed triangles its one-ring is open.
ESPDIFF_INLINE bool is_surrounded(const TopologyView& topology, std::uint32_t v) {
  const std::uint32_t begin = topology.first[v], end = topology.first[v + 1];
  for (std::uint32_t i = begin; i < end; ++i) {
    const Corners c = topology.triangles[topology.incident[i]];
    const std::uint32_t before = c.v[0] == v ? c.v[2] : c.v[1] == v ? c.v[0] : c.v[1];
    bool found = false;
    for (std::uint32_t k = begin; k < end; ++k) found = found || topology.neighbour[k] == before;
    if (!found) return false;
  }
  return begin < end;
}

/// Over the surrounded vertices: elsewhere the mean of the neighbours lies to one side. In element 0.
Buffer<UmbrellaSum> umbrella_lengths(const SurfaceMesh& mesh) {
  const TopologyView topology = mesh.view();
  const Vec4f* const x = raw(mesh.positions);
  return sum_on_device<UmbrellaSum>(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    UmbrellaSum one;
    if (!is_surrounded(topology, static_cast<std::uint32_t>(v))) return one;
    one.length = static_cast<double>(norm(umbrella(topology, x, v).xyz()));
    one.n = 1;
    return one;
  });
}

Buffer<Vec4f> triangle_centroids(const SurfaceMesh& mesh) {
  Buffer<Vec4f> centroids(mesh.n_triangles());
  const Corners* const corners = raw(mesh.topology->triangles);
  const Vec4f* const x = raw(mesh.positions);
  Vec4f* const centroid = raw(centroids);
  for_each_index(mesh.n_triangles(), [=] ESPDIFF_HD(std::size_t t) {
    const Corners& c = corners[t];
    centroid[t] = make_vec4((1.0F / 3.0F) * (x[c.v[0]].xyz() + x[c.v[1]].xyz() + x[c.v[2]].xyz()), 0.0F);
  });
  return centroids;
}

/// Corners first, then the centroids of the triangles.
Buffer<Vec4f> corners_and_centroids(const SurfaceMesh& mesh) {
  const std::size_t n_vertices = mesh.n_vertices();
  const Buffer<Vec4f> centroids = triangle_centroids(mesh);
  Buffer<Vec4f> points(n_vertices + mesh.n_triangles());
  const Vec4f *const x = raw(mesh.positions), *const centroid = raw(centroids);
  Vec4f* const point = raw(points);
  for_each_index(points.size(),
                 [=] ESPDIFF_HD(std::size_t i) { point[i] = i < n_vertices ? x[i] : centroid[i - n_vertices]; });
  return points;
}

/// A quarter of the weight at the corners and the rest at the centroid integrates quadratic functions exactly. Corners
/// alone lie on the surface's own lattice, where both surfaces are nearest to each other.
constexpr double kShareOfCorners = 0.25, kShareOfCentroids = 0.75;

ESPDIFF_INLINE double weight_of_point(const float* vertices, std::size_t n_vertices, const float* triangles,
                                      std::size_t i) {
  return i < n_vertices ? kShareOfCorners * static_cast<double>(vertices[i])
                        : kShareOfCentroids * static_cast<double>(triangles[i - n_vertices]);
}

struct DistanceSums {
  double area = 0, moment = 0, beyond = 0, within = 0;

  ESPDIFF_HD DistanceSums& operator+=(const DistanceSums& o) {
    area += o.area;
    moment += o.moment;
    beyond += o.beyond;
    within += o.within;
    return *this;
  }
};

/// Area-weighted quantities over corners_and_centroids().
/// @param distances [point]
DistanceSummary summarize(const SurfaceMesh& mesh, const Buffer<float>& distances, float limit_A) {
  const std::size_t n_vertices = mesh.n_vertices(), n = distances.size();
  const Buffer<float> of_triangles = triangle_areas(mesh), of_vertices = vertex_areas(mesh, of_triangles, nullptr);
  Buffer<float> weights(n);
  float* const rounded = raw(weights);
  const float *const vertex = raw(of_vertices), *const triangle = raw(of_triangles);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    rounded[i] = static_cast<float>(weight_of_point(vertex, n_vertices, triangle, i));
  });

  const float* const distance = raw(distances);
  const Buffer<DistanceSums> sums = sum_on_device<DistanceSums>(n, [=] ESPDIFF_HD(std::size_t i) {
    const double w = weight_of_point(vertex, n_vertices, triangle, i), d = static_cast<double>(distance[i]);
    const bool is_beyond = distance[i] > limit_A;
    DistanceSums s;
    s.area = w;
    s.moment = w * d;
    s.beyond = is_beyond ? w : 0;
    s.within = is_beyond ? 0 : w * d;
    return s;
  });
  WeightedOrder order(distances, weights);
  DistanceSums sum;
  HostReads reads;
  read_element(reads, sum, sums, 0);
  order.read_sums(reads);
  reads.wait();
  DistanceSummary result;
  result.mean = sum.moment / sum.area;
  result.area_fraction_beyond_limit = sum.beyond / sum.area;
  result.mean_within_limit = sum.area > sum.beyond ? sum.within / (sum.area - sum.beyond) : 0;
  const std::vector<float> at = order.quantiles(sum.area, {0.95, INFINITY});
  result.p95 = static_cast<double>(at[0]);
  result.max = static_cast<double>(at[1]);
  return result;
}

FitReport fit_report(const SurfaceMesh& mapped, std::shared_ptr<const Scalars> corrupt_flags,
                     std::shared_ptr<const Scalars> flipped_flags) {
  const Corners* const corners = raw(mapped.topology->triangles);
  const Vec4f* const x = raw(mapped.positions);
  const float *const corrupt = raw(corrupt_flags->values), *const flipped = raw(flipped_flags->values);
  const Buffer<FitSums> areas = sum_on_device<FitSums>(mapped.n_triangles(), [=] ESPDIFF_HD(std::size_t t) {
    FitSums s;
    s.area = 0.5 * static_cast<double>(norm(twice_area_vector(x, corners[t])));
    s.corrupt = corrupt[t] != 0.0F ? s.area : 0;
    s.flipped = flipped[t] != 0.0F ? s.area : 0;
    return s;
  });
  const Buffer<UmbrellaSum> lengths = umbrella_lengths(mapped);
  FitSums sums;
  UmbrellaSum umbrellas;
  HostReads reads;
  read_element(reads, sums, areas, 0);
  read_element(reads, umbrellas, lengths, 0);
  reads.wait();
  FitReport report;
  report.area_A2 = sums.area;
  report.corrupt_area_fraction = sums.corrupt / sums.area;
  report.flipped_area_fraction = sums.flipped / sums.area;
  report.irregularity_A = umbrellas.length / umbrellas.n;
  report.corrupt = std::move(corrupt_flags);
  report.flipped = std::move(flipped_flags);
  return report;
}

/// @param distances [point] of corners_and_centroids()
DistanceSummary distance_report(const SurfaceMesh& from, Buffer<float> distances, float limit_A) {
  auto beyond_flags = std::make_shared<Scalars>();
  beyond_flags->values.resize(from.n_triangles());
  float* const beyond_limit = raw(beyond_flags->values);
  const float* const distance = raw(distances);
  const Corners* const corners = raw(from.topology->triangles);
  for_each_index(from.n_triangles(), [=] ESPDIFF_HD(std::size_t t) {
    const Corners c = corners[t];
    const float farthest = larger(distance[c.v[0]], larger(distance[c.v[1]], distance[c.v[2]]));
    beyond_limit[t] = farthest > limit_A ? 1.0F : 0.0F;
  });
  DistanceSummary summary = summarize(from, distances, limit_A);
  summary.beyond = beyond_flags;
  auto kept = std::make_shared<Scalars>();
  kept->values = std::move(distances);
  summary.distances = kept;
  return summary;
}

/// [triangle of the part] its index in the whole.
Buffer<std::uint32_t> kept_triangles(const Buffer<float>& removed, std::size_t n_kept) {
  const std::size_t n = removed.size();
  Buffer<std::uint32_t> places(n), kept_list(n_kept);
  const float* const flag = raw(removed);
  std::uint32_t *const place = raw(places), *const kept = raw(kept_list);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t t) { place[t] = flag[t] == 0.0F ? 1U : 0U; });
  if (exclusive_scan_in_place(places) != n_kept)
    throw GeometryError("the part has another number of triangles than remain of the whole");
  for_each_index(n, [=] ESPDIFF_HD(std::size_t t) {
    if (flag[t] == 0.0F) kept[place[t]] = static_cast<std::uint32_t>(t);
  });
  return kept_list;
}

/// The values of the listed triangles.
std::shared_ptr<const Scalars> at_triangles(const ScalarsPtr& whole, const Buffer<std::uint32_t>& list) {
  auto part = std::make_shared<Scalars>();
  part->values.resize(list.size());
  const float* const from = raw(unwrap<Scalars>(whole).values);
  const std::uint32_t* const place = raw(list);
  float* const to = raw(part->values);
  for_each_index(list.size(), [=] ESPDIFF_HD(std::size_t t) { to[t] = from[place[t]]; });
  return part;
}

}  // namespace

FitReport fit_to_density(const SurfaceMesh& mapped, const AtomCells& target, float isovalue) {
  const std::size_t n = mapped.n_triangles();
  const Corners* const corners = raw(mapped.topology->triangles);
  const Vec4f* const x = raw(mapped.positions);
  const Buffer<Vec4f> centroids = triangle_centroids(mapped);
  Buffer<DensitySample> sampled(n);
  density_at_points(target, centroids, spatial_order(centroids), n, sampled);
  const DensitySample* const density = raw(sampled);
  auto corrupt_flags = std::make_shared<Scalars>();
  corrupt_flags->values.resize(n);
  auto flipped_flags = std::make_shared<Scalars>();
  flipped_flags->values.resize(n);
  float* const corrupt = raw(corrupt_flags->values);
  float* const flipped = raw(flipped_flags->values);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t t) {
    const Corners& c = corners[t];
    corrupt[t] = fabsf(density[t].value - isovalue) > kCorruptDensity ? 1.0F : 0.0F;
    // The density falls outward, so a normal along the gradient is flipped.
    flipped[t] = dot(twice_area_vector(x, c), density[t].gradient) > 0 ? 1.0F : 0.0F;
  });
  return fit_report(mapped, std::move(corrupt_flags), std::move(flipped_flags));
}

FitReport fit_without(const SurfaceMesh& part, const FitReport& whole, const Buffer<float>& removed) {
  const Buffer<std::uint32_t> kept = kept_triangles(removed, part.n_triangles());
  return fit_report(part, at_triangles(whole.corrupt, kept), at_triangles(whole.flipped, kept));
}

DistanceSummary distance_summary(const SurfaceMesh& from, const SurfaceMesh& to, float limit_A) {
  return distance_report(from, distances_to_triangles(make_triangle_tree(to), corners_and_centroids(from)), limit_A);
}

DistanceSummary distances_without(const SurfaceMesh& part, const SurfaceMesh& mesh, const DistanceSummary& whole,
                                  const Buffer<float>& removed, float limit_A) {
  const std::size_t n_vertices = part.n_vertices(), n_triangles = part.n_triangles(), n_of_whole = mesh.n_vertices();
  const Buffer<std::uint32_t> kept_list = kept_triangles(removed, n_triangles);
  Buffer<float> distances(n_vertices + n_triangles);
  const float* const of_whole = raw(unwrap<Scalars>(whole.distances).values);
  const std::uint32_t* const kept = raw(kept_list);
  const Corners* const corners = raw(mesh.topology->triangles);
  const TopologyView topology = part.view();
  float* const distance = raw(distances);
  for_each_index(n_triangles,
                 [=] ESPDIFF_HD(std::size_t t) { distance[n_vertices + t] = of_whole[n_of_whole + kept[t]]; });
  for_each_index(n_vertices, [=] ESPDIFF_HD(std::size_t v) {
    const std::uint32_t t = topology.incident[topology.first[v]];
    const Corners &own = topology.triangles[t], &same = corners[kept[t]];
    distance[v] = of_whole[own.v[0] == v ? same.v[0] : own.v[1] == v ? same.v[1] : same.v[2]];
  });
  return distance_report(part, std::move(distances), limit_A);
}

}  // namespace espdiff::ESPDIFF_BACKEND
