// point_sums.h: sums over atoms at points, in two forms with the same bits: point by point, and on the CPU in blocks of
// neighbouring points that share their atoms.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

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

/// Box around the points first .. last-1 of a list.
ESPDIFF_INLINE BlockBox box_of_points(const PointList& in, std::size_t first, std::size_t last) {
  BlockBox box{{1e30F, 1e30F, 1e30F}, {-1e30F, -1e30F, -1e30F}};
  for (std::size_t i = first; i < last; ++i) {
    const Vec3f p = in.points[in.list[i]].xyz();
    box.lower = {smaller(p.x, box.lower.x), smaller(p.y, box.lower.y), smaller(p.z, box.lower.z)};
    box.upper = {larger(p.x, box.upper.x), larger(p.y, box.upper.y), larger(p.z, box.upper.z)};
  }
  return box;
}

/// Atoms that may reach a box, in the order of the cell list.
struct NearAtoms {
  static constexpr std::size_t kMost = 1024;  ///< 64 points of a surface have about 200
  std::size_t n;
  float x[kMost + kBlock], y[kMost + kBlock], z[kMost + kBlock];
  float square[kMost + kBlock];  ///< of the reach, and a little more; negative in the lanes after the last atom
  std::uint32_t atom[kMost + kBlock];
};

/// A walk through the cells near a box, which pauses when a list of atoms is full.
struct CellWalk {
  BlockBox box;
  int x0, x1, y0, y1, z1;  ///< cells within reach
  int y, z;                ///< the present row
  std::uint32_t atom;      ///< of the present row, the next
  bool is_done;
};

ESPDIFF_INLINE CellWalk walk_near(const AtomCellsView& cells, const BlockBox& box) {
  const float reach = cells.max_reach;
  CellWalk walk{};
  walk.box = box;
  walk.x0 = cells.clamped_cell(box.lower.x - reach, 0);
  walk.x1 = cells.clamped_cell(box.upper.x + reach, 0);
  walk.y = walk.y0 = cells.clamped_cell(box.lower.y - reach, 1);
  walk.y1 = cells.clamped_cell(box.upper.y + reach, 1);
  walk.z = cells.clamped_cell(box.lower.z - reach, 2);
  walk.z1 = cells.clamped_cell(box.upper.z + reach, 2);
  return walk;
}

/// Distance from an interval to the cells `index` of an axis; a little less, because atoms were sorted by rounded
/// coordinates.
ESPDIFF_INLINE float gap_to_cells(const AtomCellsView& cells, int index, int axis, float low, float high) {
  const float begin = cells.origin[axis] + cells.cell * (static_cast<float>(index) - 0.01F);
  return larger(larger(begin - high, low - (begin + 1.02F * cells.cell)), 0.0F);
}

/// Lists atoms begin .. end-1 if they may reach the box.
ESPDIFF_INLINE void list_atoms(const AtomCellsView& cells, const BlockBox& box, std::uint32_t begin, std::uint32_t end,
                               NearAtoms& near) {
  std::size_t n = near.n;
  for (std::uint32_t a = begin; a < end; ++a) {
    const float x = cells.x[a], y = cells.y[a], z = cells.z[a], widest = 1.0001F * cells.reach[a];
    const float dx = larger(larger(box.lower.x - x, x - box.upper.x), 0.0F),
                dy = larger(larger(box.lower.y - y, y - box.upper.y), 0.0F),
                dz = larger(larger(box.lower.z - z, z - box.upper.z), 0.0F);
    near.x[n] = x;
    near.y[n] = y;
    near.z[n] = z;
    near.square[n] = widest * widest;
    near.atom[n] = a;
    // The sign instead of a branch, which could not be predicted.
    const float excess = (dx * dx + dy * dy + dz * dz) - widest * widest;
    std::uint32_t bits;
    std::memcpy(&bits, &excess, sizeof bits);
    n += bits >> 31U;
  }
  near.n = n;
}

/// Lists the next atoms of the walk, as many as there is room for.
ESPDIFF_INLINE void list_next_atoms(const AtomCellsView& cells, CellWalk& walk, NearAtoms& near) {
  near.n = 0;
  const float reach = 1.0001F * cells.max_reach;
  walk.is_done = true;
  for (; walk.z <= walk.z1 && walk.is_done; ++walk.z) {
    const float dz = gap_to_cells(cells, walk.z, 2, walk.box.lower.z, walk.box.upper.z);
    for (; walk.y <= walk.y1; ++walk.y, walk.atom = 0) {
      const float dy = gap_to_cells(cells, walk.y, 1, walk.box.lower.y, walk.box.upper.y);
      if (dy * dy + dz * dz > reach * reach) continue;
      const int row = cells.size[0] * (walk.y + cells.size[1] * walk.z);
      const std::uint32_t begin = std::max(walk.atom, cells.first[row + walk.x0]), end = cells.first[row + walk.x1 + 1];
      const std::uint32_t room = static_cast<std::uint32_t>(NearAtoms::kMost - near.n);
      if (begin < end) list_atoms(cells, walk.box, begin, std::min(end, begin + room), near);
      walk.is_done = begin + room >= end;
      walk.atom = begin + room;
      if (!walk.is_done) break;
    }
    if (!walk.is_done) break;
    walk.y = walk.y0;
  }
  for (std::size_t lane = 0; lane < kBlock; ++lane) {
    near.x[near.n + lane] = near.y[near.n + lane] = near.z[near.n + lane] = 0.0F;
    near.square[near.n + lane] = -1.0F;
  }
}

/// Atoms near several blocks of a list of points. Blocks share them where they all fit into the list; otherwise each
/// block walks by itself.
struct SharedAtoms {
  bool is_complete;
  NearAtoms near;

  ESPDIFF_INLINE void find(const AtomCellsView& cells, const PointList& in, std::size_t first_block,
                           std::size_t last_block) {
    CellWalk walk = walk_near(cells, box_of_points(in, first_block * kBlock, std::min(last_block * kBlock, in.n)));
    list_next_atoms(cells, walk, near);
    is_complete = walk.is_done;
  }
};

ESPDIFF_INLINE void load_lanes(const float* values, Lanes& lanes) { std::memcpy(&lanes, values, sizeof lanes); }

/// Bit k is set where the k-th of the atoms from `at` on may reach the box.
ESPDIFF_INLINE std::uint32_t atoms_within(const NearAtoms& near, std::size_t at, const BlockBox& box) {
  static_assert(kBlock == 8);
  Lanes x, y, z, square;
  load_lanes(near.x + at, x);
  load_lanes(near.y + at, y);
  load_lanes(near.z + at, z);
  load_lanes(near.square + at, square);
  const Lanes dx = larger_lanes(larger_lanes(box.lower.x - x, x - box.upper.x), Lanes{}),
              dy = larger_lanes(larger_lanes(box.lower.y - y, y - box.upper.y), Lanes{}),
              dz = larger_lanes(larger_lanes(box.lower.z - z, z - box.upper.z), Lanes{});
  // The sign instead of a comparison.
  const LaneMask is_near = (LaneMask)((dx * dx + dy * dy + dz * dz) - square) >> 31;
  const std::uint64_t words = joined_words(is_near & LaneMask{1, 2, 4, 8, 16, 32, 64, 128});
  return static_cast<std::uint32_t>(words | (words >> 32U));
}

/// Calls add(atom, exponent, dx, dy, dz, square, gaussian) with one lane per point of the block, for each atom that
/// reaches any of them. The Gaussian is 0 in lanes that it does not reach.
template <typename Add>
ESPDIFF_INLINE void sum_at_block(const AtomCellsView& cells, const SharedAtoms& shared, const PointList& in,
                                 std::size_t block, Add add) {
  const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, in.n);
  Lanes px, py, pz;
  for (std::size_t lane = 0; lane < kBlock; ++lane) {
    const Vec3f p = in.points[in.list[std::min(begin + lane, end - 1)]].xyz();
    px[lane] = p.x;
    py[lane] = p.y;
    pz[lane] = p.z;
  }
  const BlockBox box = box_of_points(in, begin, end);
  CellWalk walk = walk_near(cells, box);
  NearAtoms own;
  if (!shared.is_complete) list_next_atoms(cells, walk, own);
  const NearAtoms& near = shared.is_complete ? shared.near : own;
  walk.is_done = walk.is_done || shared.is_complete;
  for (std::size_t at = 0;;) {
    if (at >= near.n) {
      if (walk.is_done) break;
      list_next_atoms(cells, walk, own);
      at = 0;
      continue;
    }
    for (std::uint32_t within = atoms_within(near, at, box); within != 0; within &= within - 1) {
      const std::uint32_t a = near.atom[at + static_cast<std::size_t>(__builtin_ctz(within))];
      const float k = cells.exponent[a];
      const Lanes dx = px - cells.x[a], dy = py - cells.y[a], dz = pz - cells.z[a];
      const Lanes square = dx * dx + dy * dy + dz * dz;
      const Lanes argument = k * square;
      const LaneMask counts = argument > kCutoffExponent;
      Lanes exponential;
      exp_of_negative_lanes((Lanes)((LaneMask)argument & counts), exponential);
      add(a, k, dx, dy, dz, square, (Lanes)((LaneMask)exponential & counts));
    }
    at += kBlock;
  }
}

/// Calls blocks(first, last) in parallel for ranges of blocks that together hold n points. `blocks` is compiled for
/// several instruction sets; each call takes several blocks, so the dispatch is cheap.
template <typename Blocks>
void for_all_blocks(std::size_t n, Blocks blocks) {
  constexpr std::size_t kBlocksPerCall = 8;
  const std::size_t n_blocks = (n + kBlock - 1) / kBlock;
  for_each_index((n_blocks + kBlocksPerCall - 1) / kBlocksPerCall, [=](std::size_t call) {
    blocks(call * kBlocksPerCall, std::min((call + 1) * kBlocksPerCall, n_blocks));
  });
}

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
