// local_time_steps.cu: the intervals at which the flow of a vertex is evaluated.
#include "cuda/morph/local_time_steps.h"

#include <algorithm>

#include "cuda/device/lanes.h"

namespace espdiff::ESPDIFF_BACKEND {
namespace {

/// An atom counts as near within this share of its reach (of 4.5 standard deviations). Farther off its velocity has
/// less than 0.3 of its largest weight.
constexpr float kShareOfReach = 0.5F;

/// The atoms that move too far during the longest interval.
struct FastAtoms {
  std::shared_ptr<AtomCells> cells;  ///< null where there are none
  Buffer<float> displacement;        ///< [sorted atom] in a step, Angstrom
  float fastest = 0;
};

FastAtoms fast_atoms(const LocalTimeSteps& local, const MovingAtoms& atoms) {
  FastAtoms fast;
  std::vector<float> widths(local.displacements_A.size(), 0.0F);
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const float displacement = local.displacements_A[i];
    if (static_cast<float>(local.longest) * displacement <= local.max_displacement_A) continue;
    widths[i] = atoms.widths[i];
    if (widths[i] > 0) fast.fastest = std::max(fast.fastest, displacement);
  }
  if (fast.fastest == 0) return fast;
  Buffer<std::uint32_t> order;
  fast.cells = make_atom_cells(atoms.positions, widths, std::vector<std::int32_t>(widths.size(), 0), &order);
  fast.displacement = in_cell_order(local.displacements_A, order);
  fast.displacement.resize(order.size() + kAtomsBeyond);
  return fast;
}

struct Intervals {
  MovingSurfaceView surface;
  const std::uint32_t* order;
  AtomCellsView cells;
  const float* displacement;  ///< null where no atom is fast
  float search_reach;
  float max_displacement;
};

/// Vertices that follow each other in the spatial order and share an interval, because the search takes as long as an
/// evaluation of the flow.
constexpr std::size_t kGroup = 8;

/// The vertices of a group that do not wait.
struct Group {
  Vec3f lower, upper;
  float displacement;  ///< of the one that moves farthest in a step
  bool any;
};

ESPDIFF_INLINE Group group_of(const Intervals& in, std::size_t begin, std::size_t end, float dt) {
  Group group{{1e30F, 1e30F, 1e30F}, {-1e30F, -1e30F, -1e30F}, 0.0F, false};
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint32_t v = in.order[i];
    if (in.surface.waits[v] != 0) continue;
    const Vec3f p = in.surface.x[v].xyz();
    const Vec4f flow = in.surface.flow[v];
    group.lower = {smaller(p.x, group.lower.x), smaller(p.y, group.lower.y), smaller(p.z, group.lower.z)};
    group.upper = {larger(p.x, group.upper.x), larger(p.y, group.upper.y), larger(p.z, group.upper.z)};
    group.displacement = larger(group.displacement, dt * (norm(flow.xyz()) + fabsf(flow.w)));
    group.any = true;
  }
  return group;
}

ESPDIFF_INLINE float gap(float low, float high, float x) { return larger(larger(low - x, x - high), 0.0F); }
#if !defined(__CUDACC__)
ESPDIFF_INLINE Lanes gap_lanes(float low, float high, const Lanes& x) {
  return larger_lanes<Lanes>(larger_lanes<Lanes>(low - x, x - high), Lanes{});
}
#endif

/// Atoms whose distance from a group is looked at together.
#if defined(__CUDACC__)
constexpr std::uint32_t kAtomsAtOnce = 1;
#else
constexpr std::uint32_t kAtomsAtOnce = kBlock;
#endif

/// Whether one of the atoms [begin, end), at most kAtomsAtOnce, moves too far in an interval and can come near.
ESPDIFF_INLINE bool is_too_long(const Intervals& in, const Group& group, std::uint32_t begin, std::uint32_t end,
                                float interval) {
#if defined(__CUDACC__)
  const Vec3f d = {gap(group.lower.x, group.upper.x, in.cells.x[begin]),
                   gap(group.lower.y, group.upper.y, in.cells.y[begin]),
                   gap(group.lower.z, group.upper.z, in.cells.z[begin])};
  const float moves = interval * in.displacement[begin], near = kShareOfReach * in.cells.reach[begin] + moves;
  return begin < end && moves > in.max_displacement && dot(d, d) < near * near;
#else
  Lanes x, y, z, reach, displacement;
  load_lanes(in.cells.x + begin, x);
  load_lanes(in.cells.y + begin, y);
  load_lanes(in.cells.z + begin, z);
  load_lanes(in.cells.reach + begin, reach);
  load_lanes(in.displacement + begin, displacement);
  const Lanes dx = gap_lanes(group.lower.x, group.upper.x, x), dy = gap_lanes(group.lower.y, group.upper.y, y),
              dz = gap_lanes(group.lower.z, group.upper.z, z);
  const Lanes moves = interval * displacement, near = kShareOfReach * reach + moves;
  // Below zero where both are true.
  const Lanes excess = larger_lanes<Lanes>(in.max_displacement - moves, (dx * dx + dy * dy + dz * dz) - near * near);
  std::uint32_t lanes = bits_of(excess < Lanes{});
  if (end - begin < kAtomsAtOnce) lanes &= (1U << (end - begin)) - 1U;
  return lanes != 0;
#endif
}

/// The longest interval up to a given one in which no atom can come near that moves too far meanwhile.
ESPDIFF_INLINE std::uint32_t shortened(const Intervals& in, const Group& group, std::uint32_t interval) {
  const Vec3f centre = 0.5F * (group.lower + group.upper);
  const float reach = in.search_reach + 0.5F * norm(group.upper - group.lower);
  visit_atom_runs(in.cells, centre, reach, [&](std::uint32_t begin, std::uint32_t end) ESPDIFF_INLINE_LAMBDA {
    for (std::uint32_t a = begin; a < end && interval > 1; a += kAtomsAtOnce) {
      while (interval > 1 && is_too_long(in, group, a, end, static_cast<float>(interval))) interval /= 2;
    }
  });
  return interval;
}

/// Begins the intervals of a group, the longest ones of at most `longest` steps.
/// @param allowed an interval that no atom near the group forbids
ESPDIFF_INLINE void begin_group(const Intervals& in, std::size_t g, std::size_t n, std::uint32_t longest,
                                std::uint32_t allowed, float dt) {
  const std::size_t begin = g * kGroup, end = begin + kGroup < n ? begin + kGroup : n;
  const Group group = group_of(in, begin, end, dt);
  if (!group.any) return;
  std::uint32_t interval = longest;
  while (interval > 1 && static_cast<float>(interval) * group.displacement > in.max_displacement) interval /= 2;
  if (interval > allowed && in.displacement != nullptr) interval = shortened(in, group, interval);
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint32_t v = in.order[i];
    if (in.surface.waits[v] == 0) in.surface.clock[v].interval = interval;
  }
}

#if !defined(__CUDACC__)
constexpr std::size_t kGroupsPerCall = 8;

ESPDIFF_MULTIVERSION void begin_groups(const Intervals& in, std::size_t call, std::size_t n, std::uint32_t longest,
                                       float dt) {
  const std::size_t begin = call * kGroupsPerCall, end = std::min(begin + kGroupsPerCall, (n + kGroup - 1) / kGroup);
  // Where most is at rest, one search for all groups does.
  std::uint32_t allowed = 1;
  if (longest > 1 && in.displacement != nullptr) {
    const Group all = group_of(in, begin * kGroup, std::min(end * kGroup, n), dt);
    if (all.any) allowed = shortened(in, all, longest);
  }
  for (std::size_t g = begin; g < end; ++g) begin_group(in, g, n, longest, allowed, dt);
}
#endif

}  // namespace

void end_intervals(MovingSurface& surface, std::uint32_t step, bool all) {
  const MovingSurfaceView s = view_of(surface);
  for_each_index(surface.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    VertexClock& clock = s.clock[v];
    const bool waits = !all && clock.last + clock.interval > step;
    s.waits[v] = waits ? 1 : 0;
    if (waits) return;
    s.previous[v] = s.flow[v];
    clock.previous_interval = step - clock.last;
    clock.last = step;
  });
}

void begin_intervals(MovingSurface& surface, const LocalTimeSteps& local, const MovingAtoms& atoms, std::uint32_t step,
                     float dt) {
  if (local.longest == 1) return;  // as they are
  const FastAtoms fast = fast_atoms(local, atoms);
  Intervals in{};
  in.surface = view_of(surface);
  in.order = raw(surface.order);
  in.max_displacement = local.max_displacement_A;
  if (fast.cells != nullptr) {
    in.cells = fast.cells->view();
    in.displacement = raw(fast.displacement);
    in.search_reach = kShareOfReach * in.cells.max_reach + static_cast<float>(local.longest) * fast.fastest;
  }
  std::uint32_t longest = local.longest;
  while (step % longest != 0) longest /= 2;
  const std::size_t n = surface.n_vertices(), n_groups = (n + kGroup - 1) / kGroup;
#if defined(__CUDACC__)
  for_each_index(n_groups, [=] ESPDIFF_HD(std::size_t g) { begin_group(in, g, n, longest, 1, dt); });
#else
  for_each_index((n_groups + kGroupsPerCall - 1) / kGroupsPerCall,
                 [=](std::size_t call) { begin_groups(in, call, n, longest, dt); });
#endif
}

void wait_where_settled(MovingSurface& surface, const Buffer<Vec4f>& settled) {
  const MovingSurfaceView s = view_of(surface);
  const Vec4f* const then = raw(settled);
  const std::size_t n = settled.size();
  for_each_index(surface.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    const Vec4f now = s.x[v];
    s.waits[v] = v < n && then[v].x == now.x && then[v].y == now.y && then[v].z == now.z ? 1 : 0;
  });
}

}  // namespace espdiff::ESPDIFF_BACKEND
