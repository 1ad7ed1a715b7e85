// components.cu: labels components by hooking and pointer jumping: each vertex gets the smallest vertex index of its
// component, independent of thread order.
#include "cuda/surface/components.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "cuda/surface/submesh.h"
#include "engine/surface_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Follows labels up to a root, which labels itself.
ESPDIFF_INLINE std::uint32_t root_of(const std::uint32_t* label, std::uint32_t v) {
  std::uint32_t parent = atomic_load(&label[v]);
  while (parent != v) {
    v = parent;
    parent = atomic_load(&label[v]);
  }
  return v;
}

/// [vertex] smallest vertex index of the component.
Buffer<std::uint32_t> smallest_vertex_labels(const SurfaceMesh& mesh) {
  Buffer<std::uint32_t> labels(mesh.n_vertices());
  Buffer<std::uint32_t> changes(1);
  std::uint32_t* const label = raw(labels);
  std::uint32_t* const change = raw(changes);
  const TopologyView topology = mesh.view();
  for_each_index(labels.size(), [=] ESPDIFF_HD(std::size_t v) { label[v] = static_cast<std::uint32_t>(v); });
  do {
    changes.assign(1, 0);
    for_each_index(labels.size(), [=] ESPDIFF_HD(std::size_t v) {
      const std::uint32_t own = root_of(label, static_cast<std::uint32_t>(v));
      for (std::uint32_t n = topology.first[v]; n < topology.first[v + 1]; ++n) {
        const std::uint32_t other = root_of(label, topology.neighbour[n]);
        if (other < own && atomic_minimum(&label[own], other)) atomic_increment(change);
      }
    });
    for_each_index(labels.size(), [=] ESPDIFF_HD(std::size_t v) {
      atomic_minimum(&label[v], root_of(label, static_cast<std::uint32_t>(v)));
    });
  } while (changes[0] != 0);
  return labels;
}

}  // namespace

ComponentLabels label_components(const SurfaceMesh& mesh) {
  ComponentLabels result;
  result.label = smallest_vertex_labels(mesh);
  // There are few roots, so the host numbers them and sums areas in a fixed order.
  std::vector<std::uint32_t> label = to_host(result.label);
  for (std::size_t v = 0; v < label.size(); ++v) {
    if (label[v] == v) {
      label[v] = static_cast<std::uint32_t>(result.summaries.size());
      result.summaries.emplace_back();
    } else {
      label[v] = label[label[v]];  // a smaller vertex, hence already numbered
    }
    ++result.summaries[label[v]].n_vertices;
  }
  const std::vector<Vec4f> x = to_host(mesh.positions);
  for (const Corners& t : to_host(mesh.topology->triangles)) {
    ComponentSummary& component = result.summaries[label[t.v[0]]];
    const Vec3d a = static_cast<Vec3d>(x[t.v[0]].xyz()), b = static_cast<Vec3d>(x[t.v[1]].xyz()),
                c = static_cast<Vec3d>(x[t.v[2]].xyz());
    ++component.n_triangles;
    component.area_A2 += 0.5 * norm(cross(b - a, c - a));
    component.volume_A3 += dot(a, cross(b, c)) / 6.0;
  }
  result.label = to_device(label);
  return result;
}

std::shared_ptr<SurfaceMesh> keep_components(const SurfaceMesh& mesh, const ComponentLabels& labels,
                                             const std::vector<bool>& keep) {
  if (keep.size() != labels.summaries.size()) throw InputError("keep_components: needs one entry per component");
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
