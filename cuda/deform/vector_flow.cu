// vector_flow.cu: the boundary terms of the flow at the surfaces, and the sweeps that spread it.
#include "cuda/deform/vector_flow.h"

#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/formatted.h"
#include "cuda/deform/fields.h"
#include "cuda/surface/sample.h"
#include "engine/deform_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr const char* kStage = "gradient vector flow";
/// Sweeps between checks for convergence and cancellation.
constexpr int kSweepsPerCheck = 10;
/// Normals are imposed where the density differs from the isovalue by less than this fraction of it.
constexpr float kHeldShare = 0.5F;

void check_options(const VectorFlowOptions& o) {
  if (!(o.weight_A2 > 0))
    throw InputError("the weight of the gradient vector flow, " + formatted(o.weight_A2) +
                     " A^2, is not positive; 0.05 is usual");
  if (!(o.tolerance > 0))
    throw InputError("the tolerance of the gradient vector flow, " + formatted(o.tolerance) +
                     ", is not positive; 0.001 is usual");
  if (o.max_sweeps < 1)
    throw InputError("the gradient vector flow needs at least 1 sweep, not " + std::to_string(o.max_sweeps));
}

/// Calls body(i, j, k) for each lattice point; with few threads, one thread takes a row.
template <typename Body>
void for_each_point(const CubicLattice& lattice, Body body) {
#if defined(ESPDIFF_BACKEND_CUDA)
  const std::size_t n_x = static_cast<std::size_t>(lattice.size[0]);
  for_each_index(lattice.n_points(), [=] ESPDIFF_HD(std::size_t point) {
    const LatticeRow at = lattice_row(lattice, point / n_x);
    body(static_cast<int>(point % n_x), at.j, at.k);
  });
#else
  const std::size_t n_rows = static_cast<std::size_t>(lattice.size[1]) * static_cast<std::size_t>(lattice.size[2]);
  for_each_index(n_rows, [=](std::size_t row) {
    const LatticeRow at = lattice_row(lattice, row);
    for (int i = 0; i < lattice.size[0]; ++i) body(i, at.j, at.k);
  });
#endif
}

/// Weight with which a surface's normal holds a point: 1 on the surface, 0 from kHeldShare of the isovalue on.
ESPDIFF_INLINE float hold(float excess, float isovalue) {
  const float off = excess / (kHeldShare * isovalue), rest = 1.0F - off * off;
  return rest > 0 ? rest * rest : 0.0F;
}

/// |g|^2 g, and |g|^2 in w, from a density field's sample.
ESPDIFF_INLINE Vec4f pull(const Vec4f& density, float isovalue, float per_slope) {
  const Vec3f g = hold(density.w, isovalue) * per_slope * density.xyz();
  const float square = dot(g, g);
  return make_vec4(square * g, square);
}

/// [point] |g|^2 g, and |g|^2 in w.
Buffer<Vec4f> pulls(const SurfaceField& target, const SurfaceField* source, float isovalue) {
  const CubicLattice lattice = target.lattice;
  Buffer<Vec4f> result(lattice.n_points());
  Vec4f* const out = raw(result);
  const Vec4f* const at_target = raw(target.values);
  const float per_target_slope = 1.0F / surface_slope(target, isovalue);
  for_each_index(result.size(), [=] ESPDIFF_HD(std::size_t point) {
    out[point] = pull(at_target[point], isovalue, per_target_slope);
  });
  if (source == nullptr) return result;
  const CubicLattice source_lattice = source->lattice;
  const Vec4f* const at_source = raw(source->values);
  const float per_source_slope = 1.0F / surface_slope(*source, isovalue);
  for_each_point(lattice, [=] ESPDIFF_HD(int i, int j, int k) {
    const std::size_t point = lattice.index(i, j, k);
    const Vec4f sample = sample_trilinear(source_lattice, at_source, lattice.point(i, j, k));
    const float left = 1.0F - hold(at_target[point].w, isovalue);
    out[point] = out[point] + left * pull(sample, isovalue, per_source_slope);
  });
  return result;
}

/// One sweep: reads `from` and, for the acceleration, the sweep before it, which `to` still holds.
struct Sweep {
  CubicLattice lattice;
  const Vec4f* pull;
  const Vec4f* from;
  Vec4f* to;       // w: distance that a plain Jacobi iteration would move the point
  float coupling;  // mu / spacing^2
  float omega;
};

ESPDIFF_INLINE void relax_point(const Sweep& s, int i, int j, int k) {
  const int at[3] = {i, j, k};
  const std::size_t stride[3] = {
      1, static_cast<std::size_t>(s.lattice.size[0]),
      static_cast<std::size_t>(s.lattice.size[0]) * static_cast<std::size_t>(s.lattice.size[1])};
  const std::size_t point = s.lattice.index(i, j, k);
  Vec4f around{};
  float n = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (at[axis] > 0) {
      around = around + s.from[point - stride[axis]];
      n += 1.0F;
    }
    if (at[axis] + 1 < s.lattice.size[axis]) {
      around = around + s.from[point + stride[axis]];
      n += 1.0F;
    }
  }
  const Vec4f held = s.pull[point];
  const Vec3f solved = (1.0F / (s.coupling * n + held.w)) * (s.coupling * around.xyz() + held.xyz());
  const Vec3f before = s.to[point].xyz();
  s.to[point] = make_vec4(before + s.omega * (solved - before), norm(solved - s.from[point].xyz()));
}

struct Largest {
  float value = 0;
  ESPDIFF_HD Largest& operator+=(const Largest& other) {
    value = larger(value, other.value);
    return *this;
  }
};

}  // namespace

std::shared_ptr<SurfaceField> vector_flow(const DensityGrid& target, const DensityGrid* source, float isovalue,
                                          const VectorFlowOptions& options, const Progress& progress,
                                          VectorFlowReport* report) {
  check_options(options);
  // The field itself, what holds it, and two sweeps; on the source's own lattice its field.
  const double n_points = static_cast<double>(target.lattice.n_points()),
               n_source_points = source != nullptr ? static_cast<double>(source->lattice.n_points()) : 0;
  require_grid(n_points, sizeof(Vec4f) * (4 + n_source_points / n_points), "gradient vector flow");
  const std::shared_ptr<SurfaceField> field = density_field(target, isovalue);
  const std::shared_ptr<SurfaceField> source_field =
      source != nullptr ? density_field(*source, isovalue) : std::shared_ptr<SurfaceField>();
  const CubicLattice lattice = field->lattice;
  const std::size_t n = lattice.n_points();
  const Buffer<Vec4f> held = pulls(*field, source_field.get(), isovalue);
  Buffer<Vec4f> flow(n, Vec4f{}), next(n, Vec4f{});

  Sweep sweep{};
  sweep.lattice = lattice;
  sweep.pull = raw(held);
  sweep.coupling = static_cast<float>(options.weight_A2) / (lattice.spacing * lattice.spacing);
  // Bounds the slowest mode of a lattice of this many points; a slower one only takes longer.
  const int longest = lattice.size[0] > lattice.size[1] ? lattice.size[0] : lattice.size[1];
  const double radius = std::cos(3.14159265358979 / (longest > lattice.size[2] ? longest : lattice.size[2]));
  double omega = 1;
  VectorFlowReport result;
  while (result.sweeps < options.max_sweeps && !result.converged) {
    sweep.from = raw(flow);
    sweep.to = raw(next);
    sweep.omega = static_cast<float>(omega);
    const Sweep now = sweep;
    for_each_point(lattice, [=] ESPDIFF_HD(int i, int j, int k) { relax_point(now, i, j, k); });
    flow.swap(next);
    ++result.sweeps;
    omega = result.sweeps == 1 ? 1 / (1 - radius * radius / 2) : 1 / (1 - radius * radius * omega / 4);
    if (result.sweeps % kSweepsPerCheck == 0 || result.sweeps == options.max_sweeps) {
      const Vec4f* const u = raw(flow);
      result.residual = static_cast<double>(
          sum_over<Largest>(n, [=] ESPDIFF_HD(std::size_t point) { return Largest{u[point].w}; }).value);
      result.converged = result.residual < options.tolerance;
      progress.report(kStage, static_cast<double>(result.sweeps) / options.max_sweeps);
    }
  }
  const Vec4f* const u = raw(flow);
  Vec4f* const out = raw(field->values);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t point) { out[point] = make_vec4(u[point].xyz(), out[point].w); });
  progress.report(kStage, 1.0);
  if (report != nullptr) *report = result;
  return field;
}

}  // namespace espdiff::ESPDIFF_BACKEND
