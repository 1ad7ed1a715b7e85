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

#if defined(ESPDIFF_BACKEND_CUDA)

/// The sum of x over neighbours, in their order. They are read eight together: a GPU's thread waits for one read of
/// memory then instead of six.
ESPDIFF_INLINE Quad ring_sum(const TopologyView& topology, const Vec4f* x, std::uint32_t begin, std::uint32_t end) {
  constexpr std::uint32_t kTogether = 8;
  Quad sum{};
  for (std::uint32_t n = begin; n < end; n += kTogether) {
    Vec4f ring[kTogether];
    for (std::uint32_t i = 0; i < kTogether; ++i) ring[i] = x[topology.neighbour[n + i < end ? n + i : end - 1]];
    for (std::uint32_t i = 0; i < kTogether && n + i < end; ++i) sum = sum + quad_of(ring[i]);
  }
  return sum;
}

#else

using QuadBits = std::int32_t __attribute__((vector_size(16)));
constexpr std::uint32_t kUsualRing = 8;
/// From element kUsualRing - n on: n elements whose bits are all set, then zeros.
constexpr std::int32_t kFirstOnes[2 * kUsualRing] = {-1, -1, -1, -1, -1, -1, -1, -1};

/// The sum of x over neighbours, in their order. Up to eight, each is read, and those behind the end count as zero: how
/// many a vertex has cannot be foreseen, and a wrong guess costs a processor more than the reading.
ESPDIFF_INLINE Quad ring_sum(const TopologyView& topology, const Vec4f* x, std::uint32_t begin, std::uint32_t end) {
  Quad sum{};
  if (end - begin <= kUsualRing && begin + kUsualRing <= topology.first[topology.n_vertices]) {
    const std::int32_t* const counts = kFirstOnes + (kUsualRing - (end - begin));
    for (std::uint32_t i = 0; i < kUsualRing; ++i) {
      const QuadBits bits = (QuadBits)quad_of(x[topology.neighbour[begin + i]]) & (counts[i] - QuadBits{});
      sum = sum + (Quad)bits;
    }
    return sum;
  }
  for (std::uint32_t n = begin; n < end; ++n) sum = sum + quad_of(x[topology.neighbour[n]]);
  return sum;
}

#endif

/// Uniform umbrella Laplacian at v: mean of the one-ring minus v; zero for a vertex in no triangle.
ESPDIFF_INLINE Quad umbrella_quad(const TopologyView& topology, const Vec4f* x, std::size_t v) {
  const std::uint32_t begin = topology.first[v], end = topology.first[v + 1];
  if (begin == end) return Quad{};  // an isolated vertex stays in place
  return (1.0F / static_cast<float>(end - begin)) * ring_sum(topology, x, begin, end) - quad_of(x[v]);
}
ESPDIFF_INLINE Vec4f umbrella(const TopologyView& topology, const Vec4f* x, std::size_t v) {
  return vec4_of(umbrella_quad(topology, x, v));
}

}  // namespace espdiff::ESPDIFF_BACKEND
