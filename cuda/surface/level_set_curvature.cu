// level_set_curvature.cu: mean curvature of the analytic isosurface, from the density's first and second derivatives.
#include "cuda/surface/level_set_curvature.h"

#include "cuda/surface/density/point_sums.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr float kNearIsovalue = 0.1F;  ///< of the isovalue

/// The density with its derivatives, rho = sum g, g = exp(k d^2): sums of g, of k g d, of k g and of k^2 g d d^T.
struct DerivativeSums {
  float value = 0, kg = 0;
  Vec3f slope{};
  float xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  ESPDIFF_INLINE void add(float k, float dx, float dy, float dz, float gaussian) {
    const float first = k * gaussian, second = k * first;
    value += gaussian;
    kg += first;
    slope += first * Vec3f{dx, dy, dz};
    xx += second * dx * dx;
    yy += second * dy * dy;
    zz += second * dz * dz;
    xy += second * dx * dy;
    xz += second * dx * dz;
    yz += second * dy * dz;
  }

  /// (g^T H g - |g|^2 tr H) / (2 |g|^3) with the gradient g = 2 `slope` and the Hessian H = 2 `kg` I + 4 (xx ...).
  ESPDIFF_INLINE float mean_curvature() const {
    const double x = static_cast<double>(slope.x), y = static_cast<double>(slope.y), z = static_cast<double>(slope.z),
                 square = x * x + y * y + z * z;
    if (!(square > 0)) return NAN;
    const double along = x * x * static_cast<double>(xx) + y * y * static_cast<double>(yy) +
                         z * z * static_cast<double>(zz) + 2 * x * y * static_cast<double>(xy) +
                         2 * x * z * static_cast<double>(xz) + 2 * y * z * static_cast<double>(yz);
    const double trace = static_cast<double>(xx) + static_cast<double>(yy) + static_cast<double>(zz);
    return static_cast<float>((along - square * (trace + static_cast<double>(kg))) / (square * sqrt(square)));
  }
};

ESPDIFF_INLINE float curvature_at(const AtomCellsView& cells, Vec3f p, float isovalue) {
  DerivativeSums sums;
  sum_at_point(cells, p,
               [&](std::uint32_t, float k, float dx, float dy, float dz, float, float gaussian)
                   ESPDIFF_INLINE_LAMBDA { sums.add(k, dx, dy, dz, gaussian); });
  return fabsf(sums.value - isovalue) > kNearIsovalue * isovalue ? NAN : sums.mean_curvature();
}

}  // namespace

Buffer<float> level_set_curvature(const SurfaceMesh& mesh, const AtomCells& atoms, float isovalue) {
  Buffer<float> curvature(mesh.n_vertices());
  const AtomCellsView cells = atoms.view();
  const Vec4f* const x = raw(mesh.positions);
  float* const out = raw(curvature);
  for_each_index(mesh.n_vertices(),
                 [=] ESPDIFF_HD(std::size_t v) { out[v] = curvature_at(cells, x[v].xyz(), isovalue); });
  return curvature;
}

}  // namespace espdiff::ESPDIFF_BACKEND
