// submesh.cu: numbers the kept triangles and vertices by prefix sums and copies them.
#include "cuda/surface/mesh/submesh.h"

#include <utility>

#include "base/error.h"
#include "cuda/surface/mesh/adjacency.h"

namespace espdiff::ESPDIFF_BACKEND {

std::shared_ptr<SurfaceMesh> keep_triangles(const SurfaceMesh& mesh, const Buffer<std::uint8_t>& kept_triangles) {
  const std::size_t n_vertices = mesh.n_vertices(), n_triangles = mesh.n_triangles();
  Buffer<std::uint32_t> new_vertex(n_vertices), new_triangle(n_triangles);
  Buffer<std::uint8_t> used_vertices(n_vertices);
  const std::uint8_t* const kept = raw(kept_triangles);
  std::uint8_t* const used = raw(used_vertices);
  const TopologyView topology = mesh.view();
  const Vec4f* const old_positions = raw(mesh.positions);
  std::uint32_t* const vertex = raw(new_vertex);
  std::uint32_t* const triangle = raw(new_triangle);
  for_each_index(n_vertices, [=] ESPDIFF_HD(std::size_t v) {
    used[v] = 0;
    for (std::uint32_t n = topology.first[v]; n < topology.first[v + 1]; ++n) {
      if (kept[topology.incident[n]] != 0) used[v] = 1;
    }
    vertex[v] = used[v];
  });
  for_each_index(n_triangles, [=] ESPDIFF_HD(std::size_t t) { triangle[t] = kept[t] != 0 ? 1U : 0U; });
  HostReads totals;
  ScanTotal<std::uint32_t> vertices(new_vertex, totals), triangles(new_triangle, totals);
  totals.wait();
  const std::uint32_t n_kept_vertices = vertices.get(), n_kept_triangles = triangles.get();
  if (n_kept_triangles == 0) throw GeometryError("no triangle of the surface remains");

  auto result = std::make_shared<SurfaceMesh>();
  result->positions.resize(n_kept_vertices);
  Buffer<Corners> corners(n_kept_triangles);
  Vec4f* const positions = raw(result->positions);
  Corners* const out = raw(corners);
  for_each_index(n_vertices, [=] ESPDIFF_HD(std::size_t v) {
    if (used[v] != 0) positions[vertex[v]] = old_positions[v];
  });
  for_each_index(n_triangles, [=] ESPDIFF_HD(std::size_t t) {
    const Corners old = topology.triangles[t];
    if (kept[t] != 0) out[triangle[t]] = {{vertex[old.v[0]], vertex[old.v[1]], vertex[old.v[2]]}};
  });
  result->topology = make_topology(n_kept_vertices, std::move(corners));
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
