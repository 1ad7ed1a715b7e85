// vertex_residues.cu: sums of Gaussians by label, and the largest.
#include "cuda/surface/density/vertex_residues.h"

#include <algorithm>

#include "cuda/device/spatial_order.h"
#include "cuda/surface/density/point_sums.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// Labels that may reach a point; residues are about 20, atoms (labelled by their pairs) up to 200.
constexpr int kMostLabels = 256;

/// Densities by label at one point. If more labels reach it than the table holds, the weakest is dropped; it is near
/// the end of its atoms' reach.
struct Tally {
  std::int32_t label[kMostLabels];
  float density[kMostLabels];
  int n = 0;
  int last = 0;

  ESPDIFF_INLINE void add(std::int32_t which, float amount) {
    if (n > 0 && label[last] == which) {
      density[last] += amount;
      return;
    }
    for (int i = 0; i < n; ++i) {
      if (label[i] == which) {
        density[i] += amount;
        last = i;
        return;
      }
    }
    if (n < kMostLabels) {
      last = n++;
    } else {
      int weakest = 0;
      for (int i = 1; i < n; ++i) weakest = density[i] < density[weakest] ? i : weakest;
      if (!(density[weakest] < amount)) return;
      last = weakest;
    }
    label[last] = which;
    density[last] = amount;
  }

  ESPDIFF_INLINE std::int32_t strongest() const {
    int best = -1;
    for (int i = 0; i < n; ++i) {
      if (best < 0 || density[i] > density[best] || (density[i] == density[best] && label[i] < label[best])) best = i;
    }
    return best < 0 ? -1 : label[best];
  }
};

ESPDIFF_INLINE std::int32_t label_at(const AtomCellsView& atoms, Vec3f p) {
  Tally tally;
  sum_at_point(atoms, p, [&](std::uint32_t a, float, float, float, float, float, float gaussian) ESPDIFF_INLINE_LAMBDA {
    tally.add(atoms.residue[a], gaussian);
  });
  return tally.strongest();
}

#if !defined(__CUDACC__)

struct Labelling {
  AtomCellsView cells;
  PointList points;
  std::int32_t* labels;
};

/// Densities by label at the points of a block. Labels are found by a hash table with open addresses.
template <typename Numbers>
struct BlockTally {
  static constexpr std::uint32_t kSlots = 1024;
  std::int16_t slot[kSlots];
  std::int32_t label[kMostLabels];
  Numbers density[kMostLabels];
  int n = 0;
  bool is_full = false;

  ESPDIFF_INLINE void clear() { std::fill(slot, slot + kSlots, std::int16_t{-1}); }

  ESPDIFF_INLINE void add(std::int32_t which, const Numbers& amount) {
    std::uint32_t at = (static_cast<std::uint32_t>(which) * 2654435761U) >> 22U;
    while (slot[at] >= 0 && label[slot[at]] != which) at = (at + 1) % kSlots;
    if (slot[at] >= 0) {
      density[slot[at]] += amount;
    } else if (n == kMostLabels) {
      is_full = true;
    } else {
      slot[at] = static_cast<std::int16_t>(n);
      label[n] = which;
      density[n++] = amount;
    }
  }

  /// Per lane. Labels that do not reach a lane have no density there; -1 is the smallest and stays if none does.
  ESPDIFF_INLINE void strongest(MaskOf<Numbers>& result) const {
    using Labels = MaskOf<Numbers>;
    Numbers most{};
    result = Labels{} - 1;
    for (int i = 0; i < n; ++i) {
      const Labels own = Labels{} + label[i];
      const Labels of_equal = smaller_lanes(own, result);
      result = chosen(density[i] == most, of_equal, chosen(most < density[i], own, result));
      most = chosen(most < density[i], density[i], most);
    }
  }
};

template <std::size_t N>
ESPDIFF_INLINE void label_block(const Labelling& in, const SharedAtoms& near, std::size_t begin) {
  using Numbers = typename LaneTypes<N>::Numbers;
  BlockTally<Numbers> tally;
  tally.clear();
  sum_at_block<N>(in.cells, near, in.points, begin,
                  [&](std::uint32_t a, float, const Numbers&, const Numbers&, const Numbers&, const Numbers&,
                      const Numbers& gaussian) ESPDIFF_INLINE_LAMBDA { tally.add(in.cells.residue[a], gaussian); });
  MaskOf<Numbers> strongest;
  tally.strongest(strongest);
  for (std::size_t lane = 0; lane < N && begin + lane < in.points.n; ++lane) {
    const std::uint32_t point = in.points.list[begin + lane];
    in.labels[point] = tally.is_full ? label_at(in.cells, in.points.points[point].xyz()) : strongest[lane];
  }
}

template <std::size_t N>
ESPDIFF_INLINE void label_points(const Labelling& in, std::size_t begin, std::size_t end) {
  SharedAtoms near;
  near.find<N>(in.cells, in.points, begin, end);
  for (std::size_t block = begin; block < end; block += N) label_block<N>(in, near, block);
}

ESPDIFF_NARROW_VERSION void label_narrow(const Labelling& in, std::size_t begin, std::size_t end) {
  label_points<kBlock>(in, begin, end);
}
ESPDIFF_WIDE_VERSION void label_wide(const Labelling& in, std::size_t begin, std::size_t end) {
  label_points<kWideBlock>(in, begin, end);
}

#endif

}  // namespace

Buffer<std::int32_t> vertex_residues_point_by_point(const SurfaceMesh& mesh, const AtomCells& atoms) {
  Buffer<std::int32_t> labels(mesh.n_vertices());
  const AtomCellsView view = atoms.view();
  const Vec4f* const x = raw(mesh.positions);
  std::int32_t* const label = raw(labels);
  for_each_index(mesh.n_vertices(), [=] ESPDIFF_HD(std::size_t v) { label[v] = label_at(view, x[v].xyz()); });
  return labels;
}

Buffer<std::int32_t> vertex_residues(const SurfaceMesh& mesh, const AtomCells& atoms) {
#if defined(__CUDACC__)
  return vertex_residues_point_by_point(mesh, atoms);
#else
  const std::size_t n = mesh.n_vertices();
  const Buffer<std::uint32_t> order = spatial_order(mesh.positions);
  Buffer<std::int32_t> labels(n);
  const Labelling in{atoms.view(), {raw(mesh.positions), raw(order), n}, raw(labels)};
  for_all_blocks(n, in, label_narrow, label_wide);
  return labels;
#endif
}

}  // namespace espdiff::ESPDIFF_BACKEND
