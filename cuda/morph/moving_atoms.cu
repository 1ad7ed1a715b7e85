// moving_atoms.cu: positions of the atoms at one time, sorted into cells, and sums over them at points.
#include "cuda/morph/moving_atoms.h"

#include "cuda/morph/flow_sums.h"
#include "engine/morph_stage.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

struct MovingSampling {
  AtomCellsView cells;
  const AtomChange* change;
  PointList points;
  FlowSample* samples;
};

MovingSampling sampling(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                        std::size_t n, Buffer<FlowSample>& samples) {
  return {atoms.cells->view(), raw(atoms.change), {raw(points), raw(list), n}, raw(samples)};
}

#if !defined(__CUDACC__)

template <std::size_t N>
ESPDIFF_INLINE void sample_moving_block(const MovingSampling& in, const SharedAtoms& near, std::size_t begin) {
  using Numbers = typename LaneTypes<N>::Numbers;
  FlowSums<Numbers> sum;
  sum_at_block<N, Taken::kRoot>(
      in.cells, near, in.points, begin,
      [&](std::uint32_t a, float k, const Numbers& dx, const Numbers& dy, const Numbers& dz, const Numbers& square,
          const Numbers& root) ESPDIFF_INLINE_LAMBDA { add_atom(sum, in.change[a], k, dx, dy, dz, square, root); });
  for (std::size_t lane = 0; lane < N && begin + lane < in.points.n; ++lane) {
    in.samples[in.points.list[begin + lane]] =
        flow_sample(sum.density[lane], {sum.gx[lane], sum.gy[lane], sum.gz[lane]}, sum.blend[lane],
                    {sum.vx[lane], sum.vy[lane], sum.vz[lane]}, sum.rate[lane]);
  }
}

template <std::size_t N>
ESPDIFF_INLINE void sample_moving_points(const MovingSampling& in, std::size_t begin, std::size_t end) {
  SharedAtoms near;
  near.find<N>(in.cells, in.points, begin, end);
  for (std::size_t block = begin; block < end; block += N) sample_moving_block<N>(in, near, block);
}

ESPDIFF_NARROW_VERSION void sample_moving_narrow(const MovingSampling& in, std::size_t begin, std::size_t end) {
  sample_moving_points<kBlock>(in, begin, end);
}
ESPDIFF_WIDE_VERSION void sample_moving_wide(const MovingSampling& in, std::size_t begin, std::size_t end) {
  sample_moving_points<kWideBlock>(in, begin, end);
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
  std::vector<AtomChange> changes(atoms.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const MovingAtom& a = atoms[i];
    const double width = static_cast<double>(widths[i]);
    AtomChange& change = changes[i];
    change.velocity = static_cast<Vec3f>(a.velocity_at(time));
    change.spin = static_cast<Vec3f>(a.spin_at(time));
    change.weight = static_cast<float>(a.weight_at(time));
    change.weight_rate = static_cast<float>(a.weight_rate_at(time));
    change.exponent_rate = static_cast<float>((a.end_width - a.start_width) / (width * width * width));
    change.is_steady = change.weight == 1.0F && change.weight_rate == 0.0F && change.exponent_rate == 0.0F;
  }
  Buffer<std::uint32_t> order;
  MovingAtoms now;
  now.cells = make_atom_cells(positions, widths, std::vector<std::int32_t>(atoms.size(), 0), &order);
  now.change = in_cell_order(changes, order);
  now.positions = std::move(positions);
  now.widths = std::move(widths);
  return now;
}

void flow_point_by_point(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                         std::size_t n, Buffer<FlowSample>& samples) {
  const MovingSampling in = sampling(atoms, points, list, n, samples);
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    const std::uint32_t at = in.points.list[i];
    in.samples[at] = flow_at(in.cells, in.change, in.points.points[at].xyz());
  });
}

void flow_at_points(const MovingAtoms& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                    std::size_t n, Buffer<FlowSample>& samples) {
#if defined(__CUDACC__)
  flow_point_by_point(atoms, points, list, n, samples);
#else
  const MovingSampling in = sampling(atoms, points, list, n, samples);
  for_all_blocks(n, in, sample_moving_narrow, sample_moving_wide);
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
