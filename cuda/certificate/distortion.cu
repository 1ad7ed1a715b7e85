// distortion.cu: area ratios, symmetric Dirichlet energy, and the vertices whose area has grown beyond a limit.
#include "cuda/certificate/distortion.h"

#include <cmath>
#include <vector>

#include "base/error.h"
#include "cuda/certificate/weighted_order.h"
#include "cuda/surface/mesh/adjacency.h"
#include "engine/certificate_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// A triangle's terms of the sums.
struct TriangleChange {
  float source_area, ratio, energy;
};

/// Dot products of the two edges at a triangle's first corner.
struct Metric {
  float first, mixed, second;
};

ESPDIFF_INLINE Metric metric_of(const Vec4f* x, const Corners& c) {
  const Vec3f a = x[c.v[1]].xyz() - x[c.v[0]].xyz(), b = x[c.v[2]].xyz() - x[c.v[0]].xyz();
  return {dot(a, a), dot(a, b), dot(b, b)};
}

/// With G and M the triangle's metrics before and after, |J|^2 = tr(G^-1 M) and |J^-1|^2 = tr(M^-1 G); both have the
/// same numerator.
ESPDIFF_INLINE TriangleChange change_of(const Vec4f* from, const Vec4f* to, const Corners& c) {
  const Metric g = metric_of(from, c), m = metric_of(to, c);
  const float det_g = g.first * g.second - g.mixed * g.mixed, det_m = m.first * m.second - m.mixed * m.mixed;
  const float numerator = g.second * m.first - 2.0F * (g.mixed * m.mixed) + g.first * m.second;
  const float area_g = 0.5F * sqrtf(larger(det_g, 0.0F)), area_m = 0.5F * sqrtf(larger(det_m, 0.0F));
  const float energy = det_g > 0 && det_m > 0 ? 0.25F * (numerator / det_g + numerator / det_m) : INFINITY;
  return {area_g, area_g > 0 ? area_m / area_g : INFINITY, energy};
}

}  // namespace

DistortionReport distortion(const SurfaceMesh& source, const SurfaceMesh& mapped, double limit) {
  if (source.n_vertices() != mapped.n_vertices() || source.n_triangles() != mapped.n_triangles())
    throw GeometryError("distortion: the meshes differ in topology");
  const std::size_t n = source.n_triangles();
  const TopologyView topology = source.view();
  const Vec4f *const from = raw(source.positions), *const to = raw(mapped.positions);
  Buffer<float> areas(n), ratios(n), energies(n);
  float *const area = raw(areas), *const ratio = raw(ratios), *const energy = raw(energies);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t t) {
    const TriangleChange change = change_of(from, to, topology.triangles[t]);
    area[t] = change.source_area;
    ratio[t] = change.ratio;
    energy[t] = change.energy;
  });

  const Buffer<float> source_ring = vertex_areas(source, triangle_areas(source), nullptr),
                      mapped_ring = vertex_areas(mapped, triangle_areas(mapped), nullptr);
  const float *const before = raw(source_ring), *const after = raw(mapped_ring);
  auto flags = std::make_shared<Scalars>();
  flags->values.resize(n);
  float* const excessive = raw(flags->values);
  const float most = static_cast<float>(limit);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t t) {
    const Corners c = topology.triangles[t];
    const float old_area = before[c.v[0]] + before[c.v[1]] + before[c.v[2]],
                new_area = after[c.v[0]] + after[c.v[1]] + after[c.v[2]];
    excessive[t] = new_area > most * old_area ? 1.0F : 0.0F;
  });

  DistortionReport report;
  report.excessive = flags;
  const Buffer<double> totals =
      sum_on_device<double>(n, [=] ESPDIFF_HD(std::size_t t) { return static_cast<double>(area[t]); });
  WeightedOrder by_ratio(ratios, areas), by_energy(energies, areas);
  double total = 0;
  HostReads reads;
  read_element(reads, total, totals, 0);
  by_ratio.read_sums(reads);
  by_energy.read_sums(reads);
  reads.wait();
  const std::vector<float> ratio_at = by_ratio.quantiles(total, {0.05, 0.5, 0.95}),
                           energy_at = by_energy.quantiles(total, {0.5, 0.95});
  report.area_ratio_p05 = static_cast<double>(ratio_at[0]);
  report.area_ratio_median = static_cast<double>(ratio_at[1]);
  report.area_ratio_p95 = static_cast<double>(ratio_at[2]);
  report.dirichlet_median = static_cast<double>(energy_at[0]);
  report.dirichlet_p95 = static_cast<double>(energy_at[1]);
  return report;
}

}  // namespace espdiff::ESPDIFF_BACKEND
