// adjacency.cu: builds the compressed rows of a mesh's one-rings, and sums over them.
#include "cuda/surface/mesh/adjacency.h"

#if !defined(__CUDACC__)
#include <omp.h>
#endif

namespace espdiff::ESPDIFF_BACKEND {
namespace {

#if defined(__CUDACC__)

/// Sorts a row by triangle, because threads fill it in arbitrary order.
ESPDIFF_INLINE void sort_row(std::uint32_t* incident, std::uint32_t* neighbour, std::uint32_t begin,
                             std::uint32_t end) {
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    const std::uint32_t triangle = incident[i], vertex = neighbour[i];
    std::uint32_t j = i;
    for (; j > begin && incident[j - 1] > triangle; --j) {
      incident[j] = incident[j - 1];
      neighbour[j] = neighbour[j - 1];
    }
    incident[j] = triangle;
    neighbour[j] = vertex;
  }
}

void fill_rows(const Corners* corners, std::size_t n_triangles, std::size_t n_vertices, Topology& topology) {
  Buffer<std::uint32_t> slots(3 * n_triangles);
  std::uint32_t* const first = raw(topology.first);
  std::uint32_t* const neighbour = raw(topology.neighbour);
  std::uint32_t* const incident = raw(topology.incident);
  std::uint32_t* const slot = raw(slots);
  for_each_index(n_triangles, [=] ESPDIFF_HD(std::size_t t) {
    for (int c = 0; c < 3; ++c) slot[3 * t + c] = atomic_increment(&first[corners[t].v[c]]);
  });
  running_sum_in_place(topology.first);
  for_each_index(n_triangles, [=] ESPDIFF_HD(std::size_t t) {
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t place = first[corners[t].v[c]] + slot[3 * t + c];
      incident[place] = static_cast<std::uint32_t>(t);
      neighbour[place] = corners[t].v[(c + 1) % 3];
    }
  });
  for_each_index(n_vertices, [=] ESPDIFF_HD(std::size_t v) { sort_row(incident, neighbour, first[v], first[v + 1]); });
}

#else

/// Calls visit(triangle, corner) for the corners at vertices begin .. end-1, in ascending order.
template <typename Visit>
void visit_corners(const Corners* corners, std::size_t n_triangles, std::uint32_t begin, std::uint32_t end,
                   Visit visit) {
  for (std::size_t t = 0; t < n_triangles; ++t) {
    for (int c = 0; c < 3; ++c) {
      if (corners[t].v[c] - begin < end - begin) visit(t, c);
    }
  }
}

/// Each thread fills the rows of a range of vertices and reads all triangles, in order: no atomic operation, no sort.
void fill_rows(const Corners* corners, std::size_t n_triangles, std::size_t n_vertices, Topology& topology) {
  std::uint32_t* const first = raw(topology.first);
  std::uint32_t* const neighbour = raw(topology.neighbour);
  std::uint32_t* const incident = raw(topology.incident);
  const std::size_t n_ranges = static_cast<std::size_t>(omp_get_max_threads());
  const auto range_begin = [=](std::size_t range) { return static_cast<std::uint32_t>(range * n_vertices / n_ranges); };
  for_each_index(n_ranges, [=](std::size_t range) {
    visit_corners(corners, n_triangles, range_begin(range), range_begin(range + 1),
                  [=](std::size_t t, int c) { ++first[corners[t].v[c]]; });
  });
  running_sum_in_place(topology.first);
  Buffer<std::uint32_t> places = topology.first;
  std::uint32_t* const next = raw(places);
  for_each_index(n_ranges, [=](std::size_t range) {
    visit_corners(corners, n_triangles, range_begin(range), range_begin(range + 1), [=](std::size_t t, int c) {
      const std::uint32_t place = next[corners[t].v[c]]++;
      incident[place] = static_cast<std::uint32_t>(t);
      neighbour[place] = corners[t].v[(c + 1) % 3];
    });
  });
}

#endif

}  // namespace

std::shared_ptr<const Topology> make_topology(std::size_t n_vertices, Buffer<Corners>&& triangles) {
  auto topology = std::make_shared<Topology>();
  topology->n_vertices = n_vertices;
  topology->triangles = std::move(triangles);
  const std::size_t n_triangles = topology->triangles.size();
  topology->first.assign(n_vertices + 1, 0);
  topology->neighbour.resize(3 * n_triangles);
  topology->incident.resize(3 * n_triangles);
  fill_rows(raw(topology->triangles), n_triangles, n_vertices, *topology);
  return topology;
}

Buffer<Vec4f> vertex_normals(const SurfaceMesh& mesh) {
  Buffer<Vec4f> normals(mesh.n_vertices());
  const TopologyView topology = mesh.view();
  const Vec4f* const x = raw(mesh.positions);
  Vec4f* const normal = raw(normals);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    Vec3f sum{};
    for (std::uint32_t n = topology.first[v]; n < topology.first[v + 1]; ++n) {
      sum += twice_area_vector(x, topology.triangles[topology.incident[n]]);
    }
    const float length = norm(sum);
    normal[v] = make_vec4(length > 0 ? (1.0F / length) * sum : Vec3f{}, 0.0F);
  });
  return normals;
}

Buffer<float> triangle_areas(const SurfaceMesh& mesh) {
  Buffer<float> areas(mesh.n_triangles());
  const TopologyView topology = mesh.view();
  const Vec4f* const x = raw(mesh.positions);
  float* const area = raw(areas);
  for_each_index(mesh.n_triangles(),
                 [=] ESPDIFF_HD(std::size_t t) { area[t] = 0.5F * norm(twice_area_vector(x, topology.triangles[t])); });
  return areas;
}

Buffer<float> vertex_areas(const SurfaceMesh& mesh, const Buffer<float>& areas, const std::uint8_t* included) {
  Buffer<float> result(mesh.n_vertices());
  const TopologyView topology = mesh.view();
  const float* const area = raw(areas);
  float* const vertex_area = raw(result);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    float sum = 0;
    for (std::uint32_t n = topology.first[v]; n < topology.first[v + 1]; ++n) {
      const std::uint32_t t = topology.incident[n];
      if (included == nullptr || included[t] != 0) sum += area[t];
    }
    vertex_area[v] = sum / 3.0F;
  });
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
