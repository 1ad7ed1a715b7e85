// point_sums.h: sums over atoms at points, in two forms with the same bits: point by point, and on the CPU in blocks of
// neighbouring points that share their atoms.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "cuda/device/lanes.h"
#include "cuda/surface/density/atom_cells.h"

namespace espdiff::ESPDIFF_BACKEND {

/// The listed points, points[list[i]] for i < n. A list in spatial order makes compact blocks.
struct PointList {
  const Vec4f* points;
  const std::uint32_t* list;
  std::size_t n;
};

/// What a sum over atoms takes: their Gaussians, or the square roots of those, which are Gaussians too.
enum class Taken { kGaussian, kRoot };

template <Taken What>
constexpr float kShareOf = What == Taken::kRoot ? 0.5F : 1.0F;

/// Calls add(atom, exponent, dx, dy, dz, square, taken) with floats for each atom that reaches p, in the order of the
/// cell list. (dx, dy, dz) points from the atom to the point; `square` is its squared length.
template <Taken What = Taken::kGaussian, typename Add>
ESPDIFF_INLINE void sum_at_point(const AtomCellsView& cells, Vec3f p, Add add) {
  visit_atom_runs(cells, p, cells.max_reach, [&](std::uint32_t begin, std::uint32_t end) ESPDIFF_INLINE_LAMBDA {
    for (std::uint32_t a = begin; a < end; ++a) {
      const float dx = p.x - cells.x[a], dy = p.y - cells.y[a], dz = p.z - cells.z[a];
      const float k = cells.exponent[a];
      const float square = dx * dx + dy * dy + dz * dz;
      if (k * square > kCutoffExponent) add(a, k, dx, dy, dz, square, exp_of_negative(kShareOf<What> * (k * square)));
    }
  });
}

#if !defined(__CUDACC__)

/// exp_of_negative(share * x) per lane, with the same bits, since the share is a power of two; anything where x is
/// below -80. Casts between vectors keep their bits.
template <typename Numbers>
ESPDIFF_INLINE void exp_of_negative_lanes(float share, const Numbers& x, Numbers& result) {
  using Bits = typename TypesOf<Numbers>::Bits;
  const Numbers t = x * (share * 1.44269504F);
  constexpr float kRound = 12582912.0F;
  const Numbers rounded = t + kRound;
  const Numbers f = t - (rounded - kRound);
  const Bits scale = ((Bits)rounded + 127U) << 23;
  result = power_of_two(f) * (Numbers)scale;
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
  float x[kMost + kWideBlock], y[kMost + kWideBlock], z[kMost + kWideBlock];
  float square[kMost + kWideBlock];  ///< of the reach, and a little more; negative in the lanes after the last atom
  std::uint32_t atom[kMost + kWideBlock];
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

/// The lanes of atoms, from `at` on, that may reach the box, as bits.
/// @param square [lane] of the reach, and a little more
template <typename Numbers>
ESPDIFF_INLINE std::uint32_t lanes_within(const BlockBox& box, const float* atom_x, const float* atom_y,
                                          const float* atom_z, const Numbers& square) {
  Numbers x, y, z;
  load_lanes(atom_x, x);
  load_lanes(atom_y, y);
  load_lanes(atom_z, z);
  const Numbers dx = larger_lanes<Numbers>(larger_lanes<Numbers>(box.lower.x - x, x - box.upper.x), Numbers{}),
                dy = larger_lanes<Numbers>(larger_lanes<Numbers>(box.lower.y - y, y - box.upper.y), Numbers{}),
                dz = larger_lanes<Numbers>(larger_lanes<Numbers>(box.lower.z - z, z - box.upper.z), Numbers{});
  // The sign instead of a comparison.
  return bits_of((MaskOf<Numbers>)((dx * dx + dy * dy + dz * dz) - square) >> 31);
}

/// Lists atoms begin .. end-1 if they may reach the box.
template <std::size_t N>
ESPDIFF_INLINE void list_atoms(const AtomCellsView& cells, const BlockBox& box, std::uint32_t begin, std::uint32_t end,
                               NearAtoms& near) {
  using Numbers = typename LaneTypes<N>::Numbers;
  std::size_t n = near.n;
  for (std::uint32_t at = begin; at < end; at += N) {
    Numbers reach;
    load_lanes(cells.reach + at, reach);
    const Numbers widest = 1.0001F * reach;
    std::uint32_t within = lanes_within<Numbers>(box, cells.x + at, cells.y + at, cells.z + at, widest * widest);
    if (end - at < N) within &= (1U << (end - at)) - 1U;
    for (; within != 0; within &= within - 1) {
      const std::uint32_t a = at + static_cast<std::uint32_t>(__builtin_ctz(within));
      near.x[n] = cells.x[a];
      near.y[n] = cells.y[a];
      near.z[n] = cells.z[a];
      near.square[n] = (1.0001F * cells.reach[a]) * (1.0001F * cells.reach[a]);
      near.atom[n++] = a;
    }
  }
  near.n = n;
}

/// Lists the next atoms of the walk, as many as there is room for.
template <std::size_t N>
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
      if (begin < end) list_atoms<N>(cells, walk.box, begin, std::min(end, begin + room), near);
      walk.is_done = begin + room >= end;
      walk.atom = begin + room;
      if (!walk.is_done) break;
    }
    if (!walk.is_done) break;
    walk.y = walk.y0;
  }
  for (std::size_t lane = 0; lane < kWideBlock; ++lane) {
    near.x[near.n + lane] = near.y[near.n + lane] = near.z[near.n + lane] = 0.0F;
    near.square[near.n + lane] = -1.0F;
  }
}

/// Atoms near some points of a list. Blocks share them where they all fit into the list; otherwise each block walks by
/// itself.
struct SharedAtoms {
  bool is_complete;
  NearAtoms near;

  template <std::size_t N>
  ESPDIFF_INLINE void find(const AtomCellsView& cells, const PointList& in, std::size_t begin, std::size_t end) {
    CellWalk walk = walk_near(cells, box_of_points(in, begin, end));
    list_next_atoms<N>(cells, walk, near);
    is_complete = walk.is_done;
  }
};

/// Bit k is set where the k-th of the N atoms from `at` on may reach the box.
template <std::size_t N>
ESPDIFF_INLINE std::uint32_t atoms_within(const NearAtoms& near, std::size_t at, const BlockBox& box) {
  typename LaneTypes<N>::Numbers square;
  load_lanes(near.square + at, square);
  return lanes_within(box, near.x + at, near.y + at, near.z + at, square);
}

/// Calls add(atom, exponent, dx, dy, dz, square, taken) with one lane per point of the block of N that begins at
/// `begin`, for each atom that reaches any of them. What is taken is 0 in lanes that the atom does not reach.
template <std::size_t N, Taken What = Taken::kGaussian, typename Add>
ESPDIFF_INLINE void sum_at_block(const AtomCellsView& cells, const SharedAtoms& shared, const PointList& in,
                                 std::size_t begin, Add add) {
  using Numbers = typename LaneTypes<N>::Numbers;
  using Mask = typename LaneTypes<N>::Mask;
  const std::size_t end = std::min(begin + N, in.n);
  Numbers px, py, pz;
  for (std::size_t lane = 0; lane < N; ++lane) {
    const Vec3f p = in.points[in.list[std::min(begin + lane, end - 1)]].xyz();
    px[lane] = p.x;
    py[lane] = p.y;
    pz[lane] = p.z;
  }
  const BlockBox box = box_of_points(in, begin, end);
  CellWalk walk = walk_near(cells, box);
  NearAtoms own;
  if (!shared.is_complete) list_next_atoms<N>(cells, walk, own);
  const NearAtoms& near = shared.is_complete ? shared.near : own;
  walk.is_done = walk.is_done || shared.is_complete;
  PlacesOfOnes<NearAtoms::kMost + kWideBlock> within;
  for (;;) {
    within.n = 0;
    for (std::size_t at = 0; at < near.n; at += N) within.append<N>(atoms_within<N>(near, at, box), at);
    for (std::size_t i = 0; i < within.n; ++i) {
      const std::uint32_t a = near.atom[within.places[i]];
      const float k = cells.exponent[a];
      const Numbers dx = px - cells.x[a], dy = py - cells.y[a], dz = pz - cells.z[a];
      const Numbers square = dx * dx + dy * dy + dz * dz;
      const Numbers argument = k * square;
      const Mask counts = argument > kCutoffExponent;
      Numbers exponential;
      exp_of_negative_lanes(kShareOf<What>, argument, exponential);
      add(a, k, dx, dy, dz, square, (Numbers)((Mask)exponential & counts));
    }
    if (walk.is_done) break;
    list_next_atoms<N>(cells, walk, own);
  }
}

/// Calls points_of(in, begin, end), in parallel, for ranges of n listed points that hold whole blocks, but for the
/// last. The narrow form goes through them in blocks of kBlock, the wide one in blocks of kWideBlock, with the same
/// bits.
template <typename Input>
void for_all_blocks(std::size_t n, const Input& in, void (*narrow)(const Input&, std::size_t, std::size_t),
                    void (*wide)(const Input&, std::size_t, std::size_t)) {
  constexpr std::size_t kPointsPerCall = 64;
  const auto points_of = has_wide_vectors() ? wide : narrow;
  for_each_index((n + kPointsPerCall - 1) / kPointsPerCall, [=](std::size_t call) {
    points_of(in, call * kPointsPerCall, std::min((call + 1) * kPointsPerCall, n));
  });
}

#endif

}  // namespace espdiff::ESPDIFF_BACKEND
