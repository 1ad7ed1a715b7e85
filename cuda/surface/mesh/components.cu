// components.cu: labels components by joining trees of vertices: the root of each is the smallest vertex of its
// component, independent of thread order.
#include "cuda/surface/mesh/components.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "cuda/device/sort.h"
#include "cuda/surface/mesh/submesh.h"
#include "engine/surface_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Follows labels up to a root, which labels itself. Labels on the way skip every other vertex from then on.
ESPDIFF_INLINE std::uint32_t root_of(std::uint32_t* label, std::uint32_t v) {
  std::uint32_t parent = atomic_load(&label[v]);
  while (parent != v) {
    const std::uint32_t above = atomic_load(&label[parent]);
    if (above != parent) atomic_minimum(&label[v], above);
    v = parent;
    parent = above;
  }
  return v;
}

/// Joins the trees of two vertices: the larger root takes the smaller one as its label. Another thread may label that
/// root first; then its new root is joined.
ESPDIFF_INLINE void join(std::uint32_t* label, std::uint32_t a, std::uint32_t b) {
  a = root_of(label, a);
  b = root_of(label, b);
  while (a != b) {
    const std::uint32_t high = a > b ? a : b, low = a > b ? b : a;
    const std::uint32_t found = atomic_compare_exchange(&label[high], high, low);
    if (found == high) return;
    a = root_of(label, found);
    b = root_of(label, low);
  }
}

/// [vertex] smallest vertex of the component.
Buffer<std::uint32_t> smallest_vertices(const SurfaceMesh& mesh) {
  Buffer<std::uint32_t> labels(mesh.n_vertices());
  std::uint32_t* const label = raw(labels);
  const TopologyView topology = mesh.view();
  for_each_index(labels.size(), [=] ESPDIFF_HD(std::size_t v) { label[v] = static_cast<std::uint32_t>(v); });
  for_each_index(labels.size(), [=] ESPDIFF_HD(std::size_t v) {
    for (std::uint32_t n = topology.first[v]; n < topology.first[v + 1]; ++n) {
      if (topology.neighbour[n] < v) join(label, static_cast<std::uint32_t>(v), topology.neighbour[n]);
    }
  });
  for_each_index(labels.size(), [=] ESPDIFF_HD(std::size_t v) {
    atomic_minimum(&label[v], root_of(label, static_cast<std::uint32_t>(v)));
  });
  return labels;
}

struct TriangleSums {
  double area = 0, volume = 0;

  ESPDIFF_HD TriangleSums& operator+=(const TriangleSums& o) {
    area += o.area;
    volume += o.volume;
    return *this;
  }
};

/// The rows of some buckets, in ranges of at most kReductionChunk places.
std::vector<IndexRange> ranges_of_rows(const std::vector<std::uint32_t>& first) {
  std::vector<IndexRange> ranges;
  for (std::size_t row = 0; row + 1 < first.size(); ++row) {
    for (std::size_t begin = first[row]; begin < first[row + 1]; begin += kReductionChunk)
      ranges.push_back({begin, std::min<std::size_t>(begin + kReductionChunk, first[row + 1])});
  }
  return ranges;
}

}  // namespace

ComponentLabels label_components(const SurfaceMesh& mesh) {
  const Buffer<std::uint32_t> smallest = smallest_vertices(mesh);
  const std::size_t n = smallest.size();
  ComponentLabels result;
  result.label.resize(n);
  Buffer<std::uint32_t> numbers(n);
  const std::uint32_t* const root = raw(smallest);
  std::uint32_t* const number = raw(numbers);
  std::uint32_t* const label = raw(result.label);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { number[v] = root[v] == v ? 1U : 0U; });
  HostReads total;
  ScanTotal<std::uint32_t> n_roots(numbers, total);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t v) { label[v] = number[root[v]]; });
  total.wait();
  result.n_components = n_roots.get();
  return result;
}

std::vector<ComponentSummary> summarize_components(const SurfaceMesh& mesh, const ComponentLabels& labels) {
  const std::uint32_t* const label = raw(labels.label);
  const Corners* const corners = raw(mesh.topology->triangles);
  const Vec4f* const x = raw(mesh.positions);
  Buffer<std::uint32_t> component(mesh.n_triangles());
  std::uint32_t* const own = raw(component);
  for_each_index(component.size(), [=] ESPDIFF_HD(std::size_t t) { own[t] = label[corners[t].v[0]]; });
  const Rows vertices = sort_into_rows(labels.label, labels.n_components),
             triangles = sort_into_rows(std::move(component), labels.n_components);
  std::vector<std::uint32_t> first_vertex, first_triangle;
  HostReads reads;
  read_elements(reads, first_vertex, vertices.first, 0, labels.n_components + 1);
  read_elements(reads, first_triangle, triangles.first, 0, labels.n_components + 1);
  reads.wait();

  const std::vector<IndexRange> ranges = ranges_of_rows(first_triangle);
  const std::uint32_t* const triangle = raw(triangles.item);
  const std::vector<TriangleSums> sums =
      to_host(range_sums<TriangleSums>(to_device(ranges), [=] ESPDIFF_HD(std::size_t place) {
        const Corners c = corners[triangle[place]];
        const Vec3d a = static_cast<Vec3d>(x[c.v[0]].xyz()), b = static_cast<Vec3d>(x[c.v[1]].xyz()),
                    d = static_cast<Vec3d>(x[c.v[2]].xyz());
        TriangleSums s;
        s.area = 0.5 * norm(cross(b - a, d - a));
        s.volume = dot(a, cross(b, d)) / 6.0;
        return s;
      }));
  std::vector<ComponentSummary> summaries(labels.n_components);
  std::size_t range = 0;
  for (std::size_t c = 0; c < summaries.size(); ++c) {
    ComponentSummary& summary = summaries[c];
    summary.n_vertices = first_vertex[c + 1] - first_vertex[c];
    summary.n_triangles = first_triangle[c + 1] - first_triangle[c];
    for (; range < ranges.size() && ranges[range].begin < first_triangle[c + 1]; ++range) {
      summary.area_A2 += sums[range].area;
      summary.volume_A3 += sums[range].volume;
    }
  }
  return summaries;
}

std::shared_ptr<SurfaceMesh> keep_components(const SurfaceMesh& mesh, const ComponentLabels& labels,
                                             const std::vector<bool>& keep) {
  if (keep.size() != labels.n_components) throw InputError("keep_components: needs one entry per component");
  if (std::find(keep.begin(), keep.end(), true) == keep.end())
    throw GeometryError("no component of the surface remains");
  std::vector<std::uint8_t> flags(keep.begin(), keep.end());
  const Buffer<std::uint8_t> kept_components = to_device(flags);
  Buffer<std::uint8_t> kept_triangles(mesh.n_triangles());
  const std::uint8_t* const kept = raw(kept_components);
  const std::uint32_t* const label = raw(labels.label);
  const Corners* const corners = raw(mesh.topology->triangles);
  std::uint8_t* const triangle = raw(kept_triangles);
  for_each_index(mesh.n_triangles(), [=] ESPDIFF_HD(std::size_t t) { triangle[t] = kept[label[corners[t].v[0]]]; });
  return keep_triangles(mesh, kept_triangles);
}

}  // namespace espdiff::ESPDIFF_BACKEND
