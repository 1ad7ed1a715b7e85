// level_set_normals.cu: normals of the analytic isosurface at a mesh's vertices.
#include "cuda/surface/level_set_normals.h"

#include "cuda/device/spatial_order.h"
#include "cuda/surface/density/density_at_points.h"
#include "cuda/surface/mesh/adjacency.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr float kOnSurfaceShare = 0.1F;  ///< of the isovalue

}  // namespace

Buffer<Vec4f> level_set_normals(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue) {
  const std::size_t n = mesh.n_vertices();
  Buffer<Vec4f> normals = vertex_normals(mesh);
  Buffer<DensitySample> sampled(n);
  density_at_points(atoms, mesh.positions, spatial_order(mesh.positions), n, sampled);
  const DensitySample* const samples = raw(sampled);
  Vec4f* const normal = raw(normals);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t v) {
    const DensitySample sample = samples[v];
    const float slope = norm(sample.gradient);
    if (!(slope > 0.0F) || fabsf(sample.value - isovalue) > kOnSurfaceShare * isovalue) return;
    const Vec3f falling = (-1.0F / slope) * sample.gradient;
    if (dot(falling, normal[v].xyz()) > 0.0F) normal[v] = make_vec4(falling, 0.0F);
  });
  return normals;
}

}  // namespace espdiff::ESPDIFF_BACKEND
