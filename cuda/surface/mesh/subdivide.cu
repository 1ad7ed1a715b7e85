// subdivide.cu: marks long edges, splits them, and places the new vertices at the midpoints.
#include "cuda/surface/mesh/subdivide.h"

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/surface/mesh/split_edges.h"
#include "engine/surface_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

std::shared_ptr<SurfaceMesh> with_middles(const SurfaceMesh& mesh, const EdgeSplit& split) {
  const std::size_t n = mesh.n_vertices();
  auto result = std::make_shared<SurfaceMesh>();
  result->topology = split.topology;
  result->positions = mesh.positions;
  result->positions.resize(n + split.ends.size());
  Vec4f* const x = raw(result->positions);
  const EdgeSplit::Ends* const ends = raw(split.ends);
  for_each_index(split.ends.size(), [=] ESPDIFF_HD(std::size_t k) { x[n + k] = 0.5F * (x[ends[k].a] + x[ends[k].b]); });
  return result;
}

}  // namespace

SubdivisionResult subdivide(const SurfaceMesh& source, const SurfaceMesh& mapped, float max_edge_A) {
  if (source.topology != mapped.topology) throw GeometryError("subdivide: source and mapped mesh differ in topology");
  if (!(max_edge_A > 0)) throw InputError("the longest edge, " + formatted(max_edge_A) + " A, is not positive");
  Buffer<std::uint32_t> marks(3 * mapped.n_triangles());
  std::uint32_t* const mark = raw(marks);
  const TopologyView topology = mapped.view();
  const Vec4f* const from = raw(source.positions);
  const Vec4f* const to = raw(mapped.positions);
  for_each_index(mapped.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    for (std::uint32_t p = topology.first[v]; p < topology.first[v + 1]; ++p) {
      const std::uint32_t other = topology.neighbour[p];
      const float length = norm(to[v].xyz() - to[other].xyz());
      const bool stretched = length > norm(from[v].xyz() - from[other].xyz());
      mark[p] = v < other && stretched && length > max_edge_A ? 1U : 0U;
    }
  });
  const EdgeSplit split = split_edges(*mapped.topology, marks, mapped.positions);
  SubdivisionResult result;
  result.source = with_middles(source, split);
  result.mapped = with_middles(mapped, split);
  for (const EdgeSplit::Ends& ends : to_host(split.ends)) result.ends.push_back({ends.a, ends.b});
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
