// point_sums.h: sums over atoms at points, in two forms with the same bits: point by point, and on the CPU in blocks of
// neighbouring points that share their atoms.
#pragma once

#include <algorithm>
#include <cstdint>

#include "cuda/surface/density/atom_cells.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The listed points, points[list[i]] for i < n. A list in spatial order makes compact blocks.
struct PointList {
  const Vec4f* points;
  const std::uint32_t* list;
  std::size_t n;
};

/// Calls add(atom, exponent, dx, dy, dz, square, gaussian) with floats for each atom that reaches p, in the order of
/// the cell list. (dx, dy, dz) points from the atom to the point; `square` is its squared length.
template <typename Add>
ESPDIFF_INLINE void sum_at_point(const AtomCellsView& cells, Vec3f p, Add add) {
  visit_atom_runs(cells, p, cells.max_reach, [&](std::uint32_t begin, std::uint32_t end) ESPDIFF_INLINE_LAMBDA {
    for (std::uint32_t a = begin; a < end; ++a) {
      const float dx = p.x - cells.x[a], dy = p.y - cells.y[a], dz = p.z - cells.z[a];
      const float k = cells.exponent[a];
      const float square = dx * dx + dy * dy + dz * dz;
      if (k * square > kCutoffExponent) add(a, k, dx, dy, dz, square, exp_of_negative(k * square));
    }
  });
}

#if !defined(__CUDACC__)

/// Points per block, one per lane. Comparisons and minima of wider vectors than the processor's are taken apart into
/// single lanes by GCC 12, so blocks are no wider than AVX2's vectors.
constexpr std::size_t kBlock = 8;
using Lanes = float __attribute__((vector_size(kBlock * sizeof(float))));
using LaneMask = std::int32_t __attribute__((vector_size(kBlock * sizeof(float))));
using LaneBits = std::uint32_t __attribute__((vector_size(kBlock * sizeof(float))));

/// `a` where the mask is set, otherwise `b`. The mask should be one comparison: GCC 12 takes a combination of
/// comparisons apart into single lanes.
ESPDIFF_INLINE Lanes chosen(const LaneMask& mask, const Lanes& a, const Lanes& b) {
  return (Lanes)(((LaneMask)a & mask) | ((LaneMask)b & ~mask));
}
ESPDIFF_INLINE LaneMask chosen(const LaneMask& mask, const LaneMask& a, const LaneMask& b) {
  return (a & mask) | (b & ~mask);
}
/// In this form GCC takes one instruction for it.
ESPDIFF_INLINE Lanes smaller_lanes(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
ESPDIFF_INLINE Lanes larger_lanes(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
ESPDIFF_INLINE LaneMask smaller_lanes(const LaneMask& a, const LaneMask& b) { return a < b ? a : b; }

/// All pairs of lanes in one word by "or". Halves are joined first, because taking out words is slow.
ESPDIFF_INLINE std::uint64_t joined_words(const LaneMask& mask) {
  using Words = std::uint64_t __attribute__((vector_size(sizeof(LaneMask))));
  const Words all = (Words)mask;
  const auto half = __builtin_shufflevector(all, all, 0, 1) | __builtin_shufflevector(all, all, 2, 3);
  return half[0] | half[1];
}

ESPDIFF_INLINE bool any_lane(const LaneMask& mask) { return joined_words(mask) != 0; }

/// exp_of_negative() per lane. Casts between vectors keep their bits.
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
  const LaneBits scale = ((LaneBits)rounded + 127U) << 23;
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

/// Calls add(atom, exponent, dx, dy, dz, square, gaussian) with one lane per point of the block, for each atom that
/// reaches any of them. The Gaussian is 0 in lanes that it does not reach.
template <typename Add>
ESPDIFF_INLINE void sum_at_block(const AtomCellsView& cells, const PointList& in, std::size_t block, Add add) {
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
  visit_atoms_near(cells, box, [&](std::uint32_t a) ESPDIFF_INLINE_LAMBDA {
    const float k = cells.exponent[a];
    const Lanes dx = px - cells.x[a], dy = py - cells.y[a], dz = pz - cells.z[a];
    const Lanes square = dx * dx + dy * dy + dz * dz;
    const Lanes argument = k * square;
    const LaneMask counts = argument > kCutoffExponent;
    Lanes exponential;
    exp_of_negative_lanes((Lanes)((LaneMask)argument & counts), exponential);
    add(a, k, dx, dy, dz, square, (Lanes)((LaneMask)exponential & counts));
  });
}

/// Calls blocks(first, last) in parallel for ranges of blocks that together hold n points. `blocks` is compiled for
/// several instruction sets; each call takes several blocks, so the dispatch is cheap.
template <typename Blocks>
void for_all_blocks(std::size_t n, Blocks blocks) {
  constexpr std::size_t kBlocksPerCall = 4;
  const std::size_t n_blocks = (n + kBlock - 1) / kBlock;
  for_each_index((n_blocks + kBlocksPerCall - 1) / kBlocksPerCall, [=](std::size_t call) {
    blocks(call * kBlocksPerCall, std::min((call + 1) * kBlocksPerCall, n_blocks));
  });
}

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
