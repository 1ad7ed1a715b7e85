// flow_sums.h: the sums over atoms that make a FlowSample, for one point or for lanes of points.
#pragma once

#include "cuda/morph/moving_atoms.h"
#include "cuda/surface/density/point_sums.h"

namespace espdiff::ESPDIFF_BACKEND {

/// Sums over atoms, before the velocity is divided by `blend`. Number is float or a vector of lanes.
template <typename Number>
struct FlowSums {
  Number density{}, gx{}, gy{}, gz{}, blend{}, vx{}, vy{}, vz{}, rate{};
};

/// Adds an atom: (dx, dy, dz) from it to the point, `square` its squared length, `root` the square root of its Gaussian
/// there, 0 beyond reach.
template <typename Number>
ESPDIFF_INLINE void add_atom(FlowSums<Number>& sum, const AtomChange& change, float exponent, const Number& dx,
                             const Number& dy, const Number& dz, const Number& square, const Number& root) {
  const Number gaussian = root * root;
  Number weighted = gaussian, blended = root;
  if (!change.is_steady) {
    weighted = change.weight * gaussian;
    blended = change.weight * root;
    sum.rate += change.weight_rate * gaussian + weighted * (change.exponent_rate * square);
  }
  const Number slope = exponent * weighted;
  sum.density += weighted;
  sum.gx += slope * dx;
  sum.gy += slope * dy;
  sum.gz += slope * dz;
  sum.blend += blended;
  sum.vx += blended * (change.velocity.x + (change.spin.y * dz - change.spin.z * dy));
  sum.vy += blended * (change.velocity.y + (change.spin.z * dx - change.spin.x * dz));
  sum.vz += blended * (change.velocity.z + (change.spin.x * dy - change.spin.y * dx));
  const Number approach = dx * change.velocity.x + dy * change.velocity.y + dz * change.velocity.z;
  sum.rate -= 2.0F * (slope * approach);
}

ESPDIFF_INLINE FlowSample flow_sample(float density, Vec3f gradient, float blend, Vec3f momentum, float rate) {
  FlowSample sample;
  sample.density = density;
  sample.gradient = 2.0F * gradient;
  sample.velocity = blend > 1e-12F ? (1.0F / blend) * momentum : Vec3f{};
  sample.rate = rate;
  return sample;
}

/// The flow at one point.
ESPDIFF_INLINE FlowSample flow_at(const AtomCellsView& cells, const AtomChange* changes, Vec3f p) {
  FlowSums<float> sum;
  sum_at_point<Taken::kRoot>(cells, p,
                             [&](std::uint32_t a, float k, float dx, float dy, float dz, float square, float root)
                                 ESPDIFF_INLINE_LAMBDA { add_atom(sum, changes[a], k, dx, dy, dz, square, root); });
  return flow_sample(sum.density, {sum.gx, sum.gy, sum.gz}, sum.blend, {sum.vx, sum.vy, sum.vz}, sum.rate);
}

}  // namespace espdiff::ESPDIFF_BACKEND
