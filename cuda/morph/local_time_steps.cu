// local_time_steps.cu: a grid of the intervals that are too long, and the intervals of the vertices.
#include "cuda/morph/local_time_steps.h"

#include <algorithm>
#include <cmath>

namespace espdiff::ESPDIFF_BACKEND {
namespace {

constexpr float kCell_A = 2.0F;
/// Of an atom's reach, 4.5 standard deviations: beyond it the atom has less than a tenth of its weight at its centre.
constexpr float kShareOfReach = 0.5F;

/// Bits b and higher.
constexpr std::uint8_t from_bit(unsigned b) { return static_cast<std::uint8_t>(0xFFU << b); }

/// Spreads bits to the neighbours along one axis: bit b by radii[b] cells, which do not decrease.
/// @param stride between neighbours along the axis
void spread(std::vector<std::uint8_t>& cells, std::size_t stride, std::size_t length, const std::vector<int>& radii) {
  const std::vector<std::uint8_t> before = cells;
  // Lines of cells that lie beside each other are moved as one block.
  const std::size_t block = stride * length;
  unsigned bit = 0;
  for (int offset = 1; offset <= radii.back(); ++offset) {
    while (radii[bit] < offset) ++bit;
    const std::uint8_t kept = from_bit(bit);
    const std::size_t shift = stride * static_cast<std::size_t>(offset);
    if (shift >= block) return;
    for (std::size_t begin = 0; begin < cells.size(); begin += block) {
      for (std::size_t i = begin; i < begin + block - shift; ++i) {
        cells[i] = static_cast<std::uint8_t>(cells[i] | (before[i + shift] & kept));
        cells[i + shift] = static_cast<std::uint8_t>(cells[i + shift] | (before[i] & kept));
      }
    }
  }
}

/// The longest interval at a place.
ESPDIFF_INLINE std::uint32_t interval_at(const IntervalGridView& grid, Vec3f p) {
  int index[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float c = (p[axis] - grid.origin[axis]) / grid.cell;
    if (!(c >= 0.0F && c < static_cast<float>(grid.size[axis]))) return grid.longest;
    index[axis] = static_cast<int>(c);
  }
  const std::uint32_t too_long = grid.too_long[index[0] + grid.size[0] * (index[1] + grid.size[1] * index[2])];
  std::uint32_t interval = 1;
  while (interval < grid.longest && (too_long & interval) == 0) interval *= 2;
  return interval;
}

}  // namespace

IntervalGridView IntervalGrid::view() const {
  return {raw(too_long), {size[0], size[1], size[2]}, origin, cell, longest, max_displacement};
}

LocalTimeSteps::LocalTimeSteps(std::vector<float> displacements_A, std::uint32_t longest, float max_displacement_A)
    : displacements_A_(std::move(displacements_A)), longest_(longest), max_displacement_A_(max_displacement_A) {}

IntervalGrid LocalTimeSteps::at(const MovingAtoms& atoms) const {
  IntervalGrid grid;
  grid.longest = longest_;
  grid.max_displacement = max_displacement_A_;
  if (longest_ == 1) return grid;
  // Bit b stands for an interval of 2^(b+1) steps.
  std::vector<std::uint8_t> bits(displacements_A_.size());
  float fastest = 0;
  Vec3d lower{1e30, 1e30, 1e30}, upper{-1e30, -1e30, -1e30};
  for (std::size_t i = 0; i < bits.size(); ++i) {
    unsigned bit = 0;
    std::uint32_t interval = 2;
    while (interval <= longest_ && static_cast<float>(interval) * displacements_A_[i] <= max_displacement_A_) {
      interval *= 2;
      ++bit;
    }
    if (interval > longest_) continue;
    bits[i] = from_bit(bit);
    fastest = std::max(fastest, displacements_A_[i]);
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], atoms.positions[i][axis]);
      upper[axis] = std::max(upper[axis], atoms.positions[i][axis]);
    }
  }
  if (fastest == 0) return grid;
  std::vector<int> radii;
  for (std::uint32_t interval = 2; interval <= longest_; interval *= 2) {
    // The atom and the vertex approach each other during the interval.
    const float radius = kShareOfReach * atoms.cells->max_reach + static_cast<float>(interval) * fastest;
    radii.push_back(static_cast<int>(std::ceil(radius / kCell_A)));
  }
  const auto margin = static_cast<double>(kCell_A) * (radii.back() + 1);
  grid.cell = kCell_A;
  grid.origin = static_cast<Vec3f>(lower - Vec3d{margin, margin, margin});
  std::size_t n = 1;
  for (int axis = 0; axis < 3; ++axis) {
    grid.size[axis] = static_cast<int>((upper[axis] - lower[axis] + 2 * margin) / kCell_A) + 1;
    n *= static_cast<std::size_t>(grid.size[axis]);
  }
  std::vector<std::uint8_t> too_long(n, 0);
  const auto nx = static_cast<std::size_t>(grid.size[0]), ny = static_cast<std::size_t>(grid.size[1]),
             nz = static_cast<std::size_t>(grid.size[2]);
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (bits[i] == 0) continue;
    const auto cell = [&](int axis) {
      return static_cast<std::size_t>((static_cast<float>(atoms.positions[i][axis]) - grid.origin[axis]) / grid.cell);
    };
    std::uint8_t& at = too_long[cell(0) + nx * (cell(1) + ny * cell(2))];
    at = static_cast<std::uint8_t>(at | bits[i]);
  }
  spread(too_long, 1, nx, radii);
  spread(too_long, nx, ny, radii);
  spread(too_long, nx * ny, nz, radii);
  grid.too_long = to_device(too_long);
  return grid;
}

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

void begin_intervals(MovingSurface& surface, const IntervalGrid& grid, std::uint32_t step, float dt) {
  const MovingSurfaceView s = view_of(surface);
  const IntervalGridView g = grid.view();
  for_each_index(surface.n_vertices(), [=] ESPDIFF_HD(std::size_t v) {
    if (s.waits[v] != 0) return;
    const Vec4f flow = s.flow[v];
    const float displacement = dt * (norm(flow.xyz()) + fabsf(flow.w));
    std::uint32_t interval = interval_at(g, s.x[v].xyz());
    while (interval > 1 && (step % interval != 0 || static_cast<float>(interval) * displacement > g.max_displacement))
      interval /= 2;
    s.clock[v].interval = interval;
  });
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
