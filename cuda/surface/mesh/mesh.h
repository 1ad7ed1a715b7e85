// mesh.h: a closed triangle mesh on the device: positions, and a topology that several meshes share.
#pragma once

#include <memory>

#include "base/handles.h"
#include "base/types.h"
#include "cuda/device/device.h"

namespace espdiff::ESPDIFF_BACKEND {

/// A triangle's three vertex indices, counter-clockwise seen from outside.
struct Corners {
  std::uint32_t v[3];
};

/// Triangles and one-rings. Row v of the compressed rows, first[v] .. first[v+1]-1, holds for each triangle at v the
/// triangle and the vertex that follows v in it. In a closed, consistently oriented mesh these vertices are the
/// one-ring, each once.
struct Topology {
  std::size_t n_vertices = 0;
  Buffer<Corners> triangles;
  Buffer<std::uint32_t> first;      ///< [vertex + 1]
  Buffer<std::uint32_t> neighbour;  ///< [3 * triangle]
  Buffer<std::uint32_t> incident;   ///< [3 * triangle] triangle index, ascending within a row
};

struct TopologyView {
  std::size_t n_vertices, n_triangles;
  const Corners* triangles;
  const std::uint32_t* first;
  const std::uint32_t* neighbour;
  const std::uint32_t* incident;
};

struct SurfaceMesh : DeviceMesh {
  std::shared_ptr<const Topology> topology;
  Buffer<Vec4f> positions;  ///< [vertex] Angstrom, common frame; w is free for a stage's use

  std::size_t n_vertices() const { return positions.size(); }
  std::size_t n_triangles() const { return topology->triangles.size(); }
  TopologyView view() const {
    return {positions.size(),     topology->triangles.size(), raw(topology->triangles),
            raw(topology->first), raw(topology->neighbour),   raw(topology->incident)};
  }
};

struct Scalars : DeviceScalars {
  Buffer<float> values;
};

/// Twice the triangle's area vector; points outward, its length is twice the area.
ESPDIFF_INLINE Vec3f twice_area_vector(const Vec4f* positions, const Corners& t) {
  const Vec3f a = positions[t.v[0]].xyz();
  return cross(positions[t.v[1]].xyz() - a, positions[t.v[2]].xyz() - a);
}

}  // namespace espdiff::ESPDIFF_BACKEND
