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

ESPDIFF_INLINE void sample_moving_block(const MovingSampling& in, const SharedAtoms& near, std::size_t block) {
  FlowSums<Lanes> sum;
  sum_at_block(in.cells, near, in.points, block,
               [&](std::uint32_t a, float k, const Lanes& dx, const Lanes& dy, const Lanes& dz, const Lanes& square,
                   const Lanes& gaussian)
                   ESPDIFF_INLINE_LAMBDA { add_atom(sum, in.change[a], k, dx, dy, dz, square, gaussian); });
  const std::size_t begin = block * kBlock;
  for (std::size_t lane = 0; lane < kBlock && begin + lane < in.points.n; ++lane) {
    in.samples[in.points.list[begin + lane]] =
        flow_sample(sum.density[lane], {sum.gx[lane], sum.gy[lane], sum.gz[lane]}, sum.blend[lane],
                    {sum.vx[lane], sum.vy[lane], sum.vz[lane]}, sum.rate[lane]);
  }
}

ESPDIFF_MULTIVERSION void sample_moving_blocks(const MovingSampling& in, std::size_t first, std::size_t last) {
  SharedAtoms near;
  near.find(in.cells, in.points, first, last);
  for (std::size_t block = first; block < last; ++block) sample_moving_block(in, near, block);
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
    changes[i] = {static_cast<Vec3f>(a.velocity_at(time)), static_cast<Vec3f>(a.spin_at(time)),
                  static_cast<float>(a.weight_at(time)), static_cast<float>(a.weight_rate_at(time)),
                  static_cast<float>((a.end_width - a.start_width) / (width * width * width))};
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
  for_all_blocks(n, [=](std::size_t first, std::size_t last) { sample_moving_blocks(in, first, last); });
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
