// moving_atoms.cu: places atoms at a time and sorts them into cells; sums over them at points.
#include "moving_atoms.h"

#include <algorithm>
#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Sums over atoms, before the velocity is divided by the density. Number is float, or several lanes of it.
template <typename Number>
struct FlowSums {
  Number density{}, gx{}, gy{}, gz{}, vx{}, vy{}, vz{}, rate{};
};

/// Adds an atom: `d*` from it to the point, `square` their squares' sum, `gaussian` its Gaussian there, 0 beyond reach.
template <typename Number>
ESPDIFF_INLINE void add_atom(FlowSums<Number>& sum, const AtomChange& change, float exponent, const Number& dx,
                             const Number& dy, const Number& dz, const Number& square, const Number& gaussian) {
  const Number weighted = change.weight * gaussian;
  const Number slope = exponent * weighted;
  sum.density += weighted;
  sum.gx += slope * dx;
  sum.gy += slope * dy;
  sum.gz += slope * dz;
  sum.vx += weighted * change.velocity.x;
  sum.vy += weighted * change.velocity.y;
  sum.vz += weighted * change.velocity.z;
  const Number approach = dx * change.velocity.x + dy * change.velocity.y + dz * change.velocity.z;
  sum.rate += change.weight_rate * gaussian + weighted * (change.exponent_rate * square) - 2.0F * (slope * approach);
}

ESPDIFF_INLINE FlowSample finished(float density, Vec3f gradient, Vec3f momentum, float rate) {
  FlowSample sample;
  sample.density = density;
  sample.gradient = 2.0F * gradient;
  sample.velocity = density > 1e-12F ? (1.0F / density) * momentum : Vec3f{};
  sample.rate = rate;
  return sample;
}

struct Sampling {
  AtomCellsView cells;
  const AtomChange* change;
  const Vec4f* points;
  const std::uint32_t* list;
  std::size_t n;
  FlowSample* samples;
};

Sampling sampling(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                  std::size_t n, Buffer<FlowSample>& samples) {
  return {atoms.cells->view(), raw(atoms.change), raw(points), raw(list), n, raw(samples)};
}

#if !defined(__CUDACC__)

/// Points of a block, one to a lane.
constexpr int kBlock = 16;
using Lanes = float __attribute__((vector_size(kBlock * sizeof(float))));
using Mask = std::int32_t __attribute__((vector_size(kBlock * sizeof(float))));
using Bits = std::uint32_t __attribute__((vector_size(kBlock * sizeof(float))));

/// exp_of_negative(), lane by lane. Casts between vectors keep their bits.
ESPDIFF_INLINE void exp_of_negative_lanes(const Lanes& x, Lanes& result) {
  const Lanes t = x * 1.44269504F;
  constexpr float kRound = 12582912.0F;
  const Lanes rounded = t + kRound;
  const Lanes f = t - (rounded - kRound);
  Lanes p = 1.5403530e-4F * f + 1.3333558e-3F;
  p = p * f + 9.6181291e-3F;
  p = p * f + 5.5504109e-2F;
  p = p * f + 2.4022651e-1F;
  p = p * f + 6.9314718e-1F;
  p = p * f + 1.0F;
  const Bits scale = ((Bits)rounded + 127U) << 23;
  result = p * (Lanes)scale;
}

struct BlockBox {
  Vec3f lower, upper;
};

ESPDIFF_INLINE float gap(float value, float low, float high) {
  return value < low ? low - value : value > high ? value - high : 0.0F;
}

/// Calls visit(atom) for each atom that may reach the box, in the order of the cell list.
template <typename Visit>
ESPDIFF_INLINE void visit_atoms_near(const AtomCellsView& cells, const BlockBox& box, Visit visit) {
  const float reach = cells.max_reach;
  const int x0 = cells.clamped_cell(box.lower.x - reach, 0), x1 = cells.clamped_cell(box.upper.x + reach, 0);
  const int y0 = cells.clamped_cell(box.lower.y - reach, 1), y1 = cells.clamped_cell(box.upper.y + reach, 1);
  const int z0 = cells.clamped_cell(box.lower.z - reach, 2), z1 = cells.clamped_cell(box.upper.z + reach, 2);
  for (int z = z0; z <= z1; ++z) {
    for (int y = y0; y <= y1; ++y) {
      const int row = cells.size[0] * (y + cells.size[1] * z);
      for (std::uint32_t a = cells.first[row + x0]; a < cells.first[row + x1 + 1]; ++a) {
        const float dx = gap(cells.x[a], box.lower.x, box.upper.x), dy = gap(cells.y[a], box.lower.y, box.upper.y),
                    dz = gap(cells.z[a], box.lower.z, box.upper.z);
        const float widest = 1.0001F * cells.reach[a];
        if (dx * dx + dy * dy + dz * dz <= widest * widest) visit(a);
      }
    }
  }
}

ESPDIFF_INLINE void sample_block(const Sampling& in, std::size_t block) {
  const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, in.n);
  Lanes px, py, pz;
  BlockBox box{{1e30F, 1e30F, 1e30F}, {-1e30F, -1e30F, -1e30F}};
  for (std::size_t lane = 0; lane < kBlock; ++lane) {
    const Vec3f p = in.points[in.list[std::min(begin + lane, end - 1)]].xyz();
    px[lane] = p.x;
    py[lane] = p.y;
    pz[lane] = p.z;
    box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y), std::min(box.lower.z, p.z)};
    box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y), std::max(box.upper.z, p.z)};
  }
  FlowSums<Lanes> sum;
  visit_atoms_near(in.cells, box, [&](std::uint32_t a) ESPDIFF_INLINE_LAMBDA {
    const float k = in.cells.exponent[a];
    const Lanes dx = px - in.cells.x[a], dy = py - in.cells.y[a], dz = pz - in.cells.z[a];
    const Lanes square = dx * dx + dy * dy + dz * dz;
    const Lanes argument = k * square;
    const Mask counts = argument > kCutoffExponent;
    Lanes exponential;
    exp_of_negative_lanes((Lanes)((Mask)argument & counts), exponential);
    const Lanes gaussian = (Lanes)((Mask)exponential & counts);
    add_atom(sum, in.change[a], k, dx, dy, dz, square, gaussian);
  });
  for (std::size_t lane = 0; begin + lane < end; ++lane) {
    in.samples[in.list[begin + lane]] = finished(sum.density[lane], {sum.gx[lane], sum.gy[lane], sum.gz[lane]},
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
    positions[i] = (1 - time) * a.start + time * a.end;
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
    change[slot] = {static_cast<Vec3f>(a.end - a.start), static_cast<float>(a.weight_at(time)),
                    static_cast<float>(a.weight_rate_at(time)),
                    static_cast<float>((a.end_width - a.start_width) / (width * width * width))};
  }
  now.change = to_device(change);
  return now;
}

void flow_point_by_point(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                         std::size_t n, Buffer<FlowSample>& samples) {
  const Sampling in = sampling(atoms, points, list, n, samples);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    const Vec3f p = in.points[in.list[i]].xyz();
    FlowSums<float> sum;
    visit_atom_runs(in.cells, p, in.cells.max_reach, [&](std::uint32_t begin, std::uint32_t end) ESPDIFF_INLINE_LAMBDA {
      for (std::uint32_t a = begin; a < end; ++a) {
        const float dx = p.x - in.cells.x[a], dy = p.y - in.cells.y[a], dz = p.z - in.cells.z[a];
        const float k = in.cells.exponent[a];
        const float square = dx * dx + dy * dy + dz * dz;
        if (!(k * square > kCutoffExponent)) continue;
        add_atom(sum, in.change[a], k, dx, dy, dz, square, exp_of_negative(k * square));
      }
    });
    in.samples[in.list[i]] = finished(sum.density, {sum.gx, sum.gy, sum.gz}, {sum.vx, sum.vy, sum.vz}, sum.rate);
  });
}

void flow_at_points(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                    std::size_t n, Buffer<FlowSample>& samples) {
#if defined(__CUDACC__)
  flow_point_by_point(atoms, points, list, n, samples);
#else
  constexpr std::size_t kBlocksPerCall = 4;
  const Sampling in = sampling(atoms, points, list, n, samples);
  const std::size_t n_blocks = (n + kBlock - 1) / kBlock;
  for_each_index((n_blocks + kBlocksPerCall - 1) / kBlocksPerCall, [=](std::size_t call) {
    sample_blocks(in, call * kBlocksPerCall, std::min((call + 1) * kBlocksPerCall, n_blocks));
  });
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
