// project.cu: Newton's method onto the analytic isosurface.
#include "project.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr int kMaxNewtonSteps = 6;
/// Within this part of the isovalue one more step lands on it to 1e-4: Newton's error is the square of this times the
/// curvature.
constexpr float kLastStepShare = 0.008F;
/// A step may be no longer than this part of the whole shift allowed: the density is far from linear over longer ones.
constexpr float kStepShare = 0.5F;

ESPDIFF_INLINE Vec3f newton(const AtomCellsView& atoms, Vec3f start, float isovalue, float max_shift) {
  Vec3f p = start;
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const DensitySample sample = density_at(atoms, p);
    const float excess = sample.value - isovalue;
    const float slope_squared = dot(sample.gradient, sample.gradient);
    if (!(slope_squared > 1e-12F)) return start;
    Vec3f shift = (-excess / slope_squared) * sample.gradient;
    const float length = norm(shift);
    if (length > kStepShare * max_shift) shift = (kStepShare * max_shift / length) * shift;
    p += shift;
    if (norm(p - start) > max_shift) return start;
    if (fabsf(excess) < kLastStepShare * isovalue) return p;
  }
  return p;
}

}  // namespace

std::shared_ptr<SurfaceMesh> project(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue,
                                     float max_shift_A) {
  auto result = std::make_shared<SurfaceMesh>();
  result->topology = mesh.topology;
  result->positions.resize(mesh.n_vertices());
  const AtomCellsView view = atoms.view();
  const Vec4f* const from = raw(mesh.positions);
  Vec4f* const to = raw(result->positions);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    to[v] = make_vec4(newton(view, from[v].xyz(), isovalue, max_shift_A), 0.0F);
  });
  return result;
}

}  // namespace espdiff::ESPDIFF_BACKEND
