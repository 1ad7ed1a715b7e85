// moving_atoms.cu: positions of the atoms at one time, sorted into cells, and sums over them at points.
#include "cuda/morph/moving_atoms.h"

#include "cuda/surface/point_sums.h"
#include "engine/morph_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Sums over atoms, before the velocity is divided by `blend`. Number is float or a vector of lanes.
template <typename Number>
struct FlowSums {
  Number density{}, gx{}, gy{}, gz{}, blend{}, vx{}, vy{}, vz{}, rate{};
};

ESPDIFF_INLINE void square_root(float x, float& result) { result = sqrtf(x); }
#if !defined(__CUDACC__)
ESPDIFF_INLINE void square_root(const Lanes& x, Lanes& result) {
  for (std::size_t lane = 0; lane < kBlock; ++lane) result[lane] = sqrtf(x[lane]);
}
#endif

/// Adds an atom: (dx, dy, dz) from it to the point, `square` its squared length, `gaussian` its Gaussian there, 0
/// beyond reach.
template <typename Number>
ESPDIFF_INLINE void add_atom(FlowSums<Number>& sum, const AtomChange& change, float exponent, const Number& dx,
                             const Number& dy, const Number& dz, const Number& square, const Number& gaussian) {
  const Number weighted = change.weight * gaussian;
  const Number slope = exponent * weighted;
  sum.density += weighted;
  sum.gx += slope * dx;
  sum.gy += slope * dy;
  sum.gz += slope * dz;
  Number blended{};
  square_root(gaussian, blended);
  blended = change.weight * blended;
  sum.blend += blended;
  sum.vx += blended * (change.velocity.x + (change.spin.y * dz - change.spin.z * dy));
  sum.vy += blended * (change.velocity.y + (change.spin.z * dx - change.spin.x * dz));
  sum.vz += blended * (change.velocity.z + (change.spin.x * dy - change.spin.y * dx));
  const Number approach = dx * change.velocity.x + dy * change.velocity.y + dz * change.velocity.z;
  sum.rate += change.weight_rate * gaussian + weighted * (change.exponent_rate * square) - 2.0F * (slope * approach);
}

ESPDIFF_INLINE FlowSample finished(float density, Vec3f gradient, float blend, Vec3f momentum, float rate) {
  FlowSample sample;
  sample.density = density;
  sample.gradient = 2.0F * gradient;
  sample.velocity = blend > 1e-12F ? (1.0F / blend) * momentum : Vec3f{};
  sample.rate = rate;
  return sample;
}

struct Sampling {
  AtomCellsView cells;
  const AtomChange* change;
  PointList points;
  FlowSample* samples;
};

Sampling sampling(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                  std::size_t n, Buffer<FlowSample>& samples) {
  return {atoms.cells->view(), raw(atoms.change), {raw(points), raw(list), n}, raw(samples)};
}

#if !defined(__CUDACC__)

ESPDIFF_INLINE void sample_block(const Sampling& in, std::size_t block) {
  FlowSums<Lanes> sum;
  sum_at_block(in.cells, in.points, block,
               [&](std::uint32_t a, float k, const Lanes& dx, const Lanes& dy, const Lanes& dz, const Lanes& square,
                   const Lanes& gaussian)
                   ESPDIFF_INLINE_LAMBDA { add_atom(sum, in.change[a], k, dx, dy, dz, square, gaussian); });
  const std::size_t begin = block * kBlock;
  for (std::size_t lane = 0; lane < kBlock && begin + lane < in.points.n; ++lane) {
    in.samples[in.points.list[begin + lane]] =
        finished(sum.density[lane], {sum.gx[lane], sum.gy[lane], sum.gz[lane]}, sum.blend[lane],
                 {sum.vx[lane], sum.vy[lane], sum.vz[lane]}, sum.rate[lane]);
  }
}

ESPDIFF_MULTIVERSION void sample_blocks(const Sampling& in, std::size_t first, std::size_t last) {
  for (std::size_t block = first; block < last; ++block) sample_block(in, block);
}

#endif

}  // namespace

MovingAtoms atoms_at(const std::vector<MovingAtom>& atoms, double time) {
  std::vector<Vec3d> positions(atoms.size());
  std::vector<float> widths(atoms.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const MovingAtom& a = atoms[i];
    positions[i] = a.position_at(time);
    const bool there = a.weight_at(time) > 0 || a.weight_rate_at(time) > 0;
    widths[i] = there ? static_cast<float>((1 - time) * a.start_width + time * a.end_width) : 0.0F;
  }
  std::vector<std::uint32_t> order;
  MovingAtoms now;
  now.cells = make_atom_cells(positions, widths, std::vector<std::int32_t>(atoms.size(), 0), &order);
  std::vector<AtomChange> change(order.size());
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    const MovingAtom& a = atoms[order[slot]];
    const double width = static_cast<double>(widths[order[slot]]);
    change[slot] = {static_cast<Vec3f>(a.velocity_at(time)), static_cast<Vec3f>(a.spin_at(time)),
                    static_cast<float>(a.weight_at(time)), static_cast<float>(a.weight_rate_at(time)),
                    static_cast<float>((a.end_width - a.start_width) / (width * width * width))};
  }
  now.change = to_device(change);
  return now;
}

void flow_point_by_point(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                         std::size_t n, Buffer<FlowSample>& samples) {
  const Sampling in = sampling(atoms, points, list, n, samples);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    const std::uint32_t at = in.points.list[i];
    FlowSums<float> sum;
    sum_at_point(in.cells, in.points.points[at].xyz(),
                 [&](std::uint32_t a, float k, float dx, float dy, float dz, float square, float gaussian)
                     ESPDIFF_INLINE_LAMBDA { add_atom(sum, in.change[a], k, dx, dy, dz, square, gaussian); });
    in.samples[at] = finished(sum.density, {sum.gx, sum.gy, sum.gz}, sum.blend, {sum.vx, sum.vy, sum.vz}, sum.rate);
  });
}

void flow_at_points(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                    std::size_t n, Buffer<FlowSample>& samples) {
#if defined(__CUDACC__)
  flow_point_by_point(atoms, points, list, n, samples);
#else
  const Sampling in = sampling(atoms, points, list, n, samples);
  for_all_blocks(n, [=](std::size_t first, std::size_t last) { sample_blocks(in, first, last); });
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
