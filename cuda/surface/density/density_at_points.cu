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

template <std::size_t N>
ESPDIFF_INLINE void sample_block(const Sampling& in, const SharedAtoms& near, std::size_t begin) {
  using Numbers = typename LaneTypes<N>::Numbers;
  DensitySums<Numbers> sum;
  sum_at_block<N>(in.cells, near, in.points, begin,
                  [&](std::uint32_t, float k, const Numbers& dx, const Numbers& dy, const Numbers& dz, const Numbers&,
                      const Numbers& gaussian) ESPDIFF_INLINE_LAMBDA { add_atom(sum, k, dx, dy, dz, gaussian); });
  for (std::size_t lane = 0; lane < N && begin + lane < in.points.n; ++lane)
    in.samples[in.points.list[begin + lane]] = {sum.value[lane],
                                                2.0F * Vec3f{sum.gx[lane], sum.gy[lane], sum.gz[lane]}};
}

template <std::size_t N>
ESPDIFF_INLINE void sample_points(const Sampling& in, std::size_t begin, std::size_t end) {
  SharedAtoms near;
  near.find<N>(in.cells, in.points, begin, end);
  for (std::size_t block = begin; block < end; block += N) sample_block<N>(in, near, block);
}

ESPDIFF_NARROW_VERSION void sample_narrow(const Sampling& in, std::size_t begin, std::size_t end) {
  sample_points<kBlock>(in, begin, end);
}
ESPDIFF_WIDE_VERSION void sample_wide(const Sampling& in, std::size_t begin, std::size_t end) {
  sample_points<kWideBlock>(in, begin, end);
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
  for_all_blocks(n, in, sample_narrow, sample_wide);
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
