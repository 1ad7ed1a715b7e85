// adjacency.h: quantities of a mesh's topology and positions: one-rings, vertex normals, vertex areas, umbrella
// Laplacians.
#pragma once

#include "cuda/device/quad.h"
#include "cuda/surface/mesh/mesh.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Builds the rows from the triangles.
std::shared_ptr<const Topology> make_topology(std::size_t n_vertices, Buffer<Corners>&& triangles);

/// [vertex] unit outward normals, the area-weighted mean of the incident triangles' normals; zero where they cancel.
Buffer<Vec4f> vertex_normals(const SurfaceMesh& mesh);

/// [triangle] area, Angstrom^2.
Buffer<float> triangle_areas(const SurfaceMesh& mesh);

/// [vertex] one third of the area of the incident triangles with nonzero `included` (null includes all).
Buffer<float> vertex_areas(const SurfaceMesh& mesh, const Buffer<float>& areas, const std::uint8_t* included);

/// Neighbours that umbrella() reads together. A GPU's thread waits for one read of memory then instead of six.
#if defined(ESPDIFF_BACKEND_CUDA)
constexpr std::uint32_t kNeighboursTogether = 8;
#else
constexpr std::uint32_t kNeighboursTogether = 1;
#endif

/// Uniform umbrella Laplacian at v: mean of the one-ring minus v; zero for a vertex in no triangle.
ESPDIFF_INLINE Vec4f umbrella(const TopologyView& topology, const Vec4f* x, std::size_t v) {
  const std::uint32_t begin = topology.first[v], end = topology.first[v + 1];
  Quad sum{};
  for (std::uint32_t n = begin; n < end; n += kNeighboursTogether) {
    Vec4f ring[kNeighboursTogether];
    for (std::uint32_t i = 0; i < kNeighboursTogether; ++i)
      ring[i] = x[topology.neighbour[n + i < end ? n + i : end - 1]];
    for (std::uint32_t i = 0; i < kNeighboursTogether && n + i < end; ++i) sum = sum + quad_of(ring[i]);
  }
  if (begin == end) return {};  // an isolated vertex stays in place
  return vec4_of((1.0F / static_cast<float>(end - begin)) * sum - quad_of(x[v]));
}

}  // namespace espdiff::ESPDIFF_BACKEND
