// density_at_points.cu: sums of Gaussians and of their gradients at points.
#include "cuda/surface/density/density_at_points.h"

#include "cuda/surface/density/density_sums.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

struct Sampling {
  AtomCellsView cells;
  PointList points;
  DensitySample* samples;
};

#if !defined(__CUDACC__)

ESPDIFF_INLINE void sample_block(const Sampling& in, const SharedAtoms& near, std::size_t block) {
  DensitySums<Lanes> sum;
  sum_at_block(in.cells, near, in.points, block,
               [&](std::uint32_t, float k, const Lanes& dx, const Lanes& dy, const Lanes& dz, const Lanes&,
                   const Lanes& gaussian) ESPDIFF_INLINE_LAMBDA { add_atom(sum, k, dx, dy, dz, gaussian); });
  const std::size_t begin = block * kBlock;
  for (std::size_t lane = 0; lane < kBlock && begin + lane < in.points.n; ++lane)
    in.samples[in.points.list[begin + lane]] = {sum.value[lane],
                                                2.0F * Vec3f{sum.gx[lane], sum.gy[lane], sum.gz[lane]}};
}

ESPDIFF_MULTIVERSION void sample_blocks(const Sampling& in, std::size_t first, std::size_t last) {
  SharedAtoms near;
  near.find(in.cells, in.points, first, last);
  for (std::size_t block = first; block < last; ++block) sample_block(in, near, block);
}

#endif

}  // namespace

void density_point_by_point(const AtomCells& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                            std::size_t n, Buffer<DensitySample>& samples) {
  const Sampling in{atoms.view(), {raw(points), raw(list), n}, raw(samples)};
  for_each_index(n, [=] ESPDIFF_HD(std::size_t i) {
    const std::uint32_t at = in.points.list[i];
    in.samples[at] = density_at(in.cells, in.points.points[at].xyz());
  });
}

void density_at_points(const AtomCells& atoms, const Buffer<Vec4f>& points, const Buffer<std::uint32_t>& list,
                       std::size_t n, Buffer<DensitySample>& samples) {
#if defined(__CUDACC__)
  density_point_by_point(atoms, points, list, n, samples);
#else
  const Sampling in{atoms.view(), {raw(points), raw(list), n}, raw(samples)};
  for_all_blocks(n, [=](std::size_t first, std::size_t last) { sample_blocks(in, first, last); });
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
