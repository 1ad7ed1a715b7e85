// metrics.cu: area-weighted sums over the mapped mesh.
#include "cuda/certificate/metrics.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "cuda/surface/mesh/adjacency.h"
#include "engine/certificate_stage.h"
#include "engine/potential_sums.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Sums over vertices.
struct Sums : PotentialSums {
  double displacement = 0, path_length = 0;

  ESPDIFF_HD Sums& operator+=(const Sums& o) {
    PotentialSums::operator+=(o);
    displacement += o.displacement;
    path_length += o.path_length;
    return *this;
  }
};

Metrics finish(const Sums& sums) {
  Metrics m = sums.metrics();
  m.mean_displacement_A = sums.displacement / sums.area_A2;
  m.mean_path_length_A = sums.path_length / sums.area_A2;
  return m;
}

void check_sizes(std::size_t n, const Scalars& a, const Scalars& b) {
  if (a.values.size() != n || b.values.size() != n)
    throw InputError("compare: needs one potential per vertex of the mapped mesh");
}

}  // namespace

Metrics compare_potentials(const SurfaceMesh& source, const SurfaceMesh& mapped, const Scalars& source_potential,
                           const Scalars& target_potential, const Scalars* excluded, const Scalars* path_length) {
  check_sizes(mapped.n_vertices(), source_potential, target_potential);
  if (source.topology != mapped.topology) throw InputError("compare: source and mapped mesh differ in topology");
  const TopologyView topology = mapped.view();
  const Vec4f* const from = raw(source.positions);
  const Vec4f* const to = raw(mapped.positions);
  const float* const a = raw(source_potential.values);
  const float* const b = raw(target_potential.values);
  if (excluded != nullptr && excluded->values.size() != mapped.n_triangles()) {
    throw InputError("compare: the exclusion needs one entry per triangle");
  }
  if (path_length != nullptr && path_length->values.size() != mapped.n_vertices())
    throw InputError("compare: needs one path length per vertex of the mapped mesh");
  const float* const lengths = path_length != nullptr ? raw(path_length->values) : nullptr;
  const float* const is_excluded = excluded != nullptr ? raw(excluded->values) : nullptr;

  Buffer<std::uint8_t> included_triangles(topology.n_triangles);
  std::uint8_t* const included = raw(included_triangles);
  for_each_index(topology.n_triangles, [=] ESPDIFF_HD(std::size_t t) {
    bool counts = is_excluded == nullptr || is_excluded[t] == 0.0F;
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t v = topology.triangles[t].v[c];
      counts = counts && is_finite(a[v]) && is_finite(b[v]);
    }
    included[t] = counts ? 1 : 0;
  });
  const Buffer<float> areas = triangle_areas(mapped);
  const Buffer<float> weights = vertex_areas(mapped, areas, included);
  const float* const weight = raw(weights);
  Metrics metrics = finish(sum_over<Sums>(mapped.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    Sums s;
    if (!(weight[v] > 0)) return s;
    const double w = static_cast<double>(weight[v]), pa = static_cast<double>(a[v]), pb = static_cast<double>(b[v]),
                 d = pb - pa;
    s.area_A2 = w;
    s.abs_difference = w * fabs(d);
    s.squared_difference = w * d * d;
    s.difference = w * d;
    s.sign_change = (pa < 0 && pb > 0) || (pa > 0 && pb < 0) ? w : 0;
    s.a = w * pa;
    s.b = w * pb;
    s.aa = w * pa * pa;
    s.bb = w * pb * pb;
    s.ab = w * pa * pb;
    s.path_length = lengths != nullptr ? w * static_cast<double>(lengths[v]) : 0.0;
    s.displacement = w * static_cast<double>(norm(to[v].xyz() - from[v].xyz()));
    return s;
  }));
  if (lengths == nullptr) metrics.mean_path_length_A = std::numeric_limits<double>::quiet_NaN();
  return metrics;
}

std::shared_ptr<Scalars> displacement(const SurfaceMesh& a, const SurfaceMesh& b) {
  if (a.n_vertices() != b.n_vertices()) throw InputError("displacement: the meshes differ in topology");
  auto result = std::make_shared<Scalars>();
  result->values.resize(a.n_vertices());
  const Vec4f* const from = raw(a.positions);
  const Vec4f* const to = raw(b.positions);
  float* const out = raw(result->values);
  for_each_index(a.n_vertices(), [=] ESPDIFF_HD(std::size_t v) { out[v] = norm(to[v].xyz() - from[v].xyz()); });
  return result;
}

double surface_area(const SurfaceMesh& mesh) {
  const Corners* const corners = raw(mesh.topology->triangles);
  const Vec4f* const x = raw(mesh.positions);
  return sum_over<double>(mesh.n_triangles(), [=] ESPDIFF_HD(std::size_t t) {
    return 0.5 * static_cast<double>(norm(twice_area_vector(x, corners[t])));
  });
}

}  // namespace espdiff::ESPDIFF_BACKEND
