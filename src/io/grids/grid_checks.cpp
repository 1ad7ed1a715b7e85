// grid_checks.cpp: checks that the grid formats share.
#include "io/grids/grid_checks.h"

#include <cmath>
#include <limits>
#include <new>

#include "base/error.h"
#include "base/memory.h"

namespace espdiff {

std::array<int, 3> check_counts(const std::array<long long, 3>& counts, const std::string& path, long line) {
  const std::string shown =
      std::to_string(counts[0]) + " x " + std::to_string(counts[1]) + " x " + std::to_string(counts[2]);
  std::array<int, 3> checked{};
  long long product = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (counts[axis] < 2) {
      throw FormatError(path, line, "the grid has " + shown + " points; at least 2 along each axis were expected");
    }
    constexpr long long kMost = std::numeric_limits<int>::max();
    if (counts[axis] > kMost / product) {
      throw FormatError(path, line,
                        "the grid has " + shown + " points; at most 2^31 - 1 can be read; crop or coarsen it");
    }
    product *= counts[axis];
    checked[axis] = static_cast<int>(counts[axis]);
  }
  return checked;
}

void check_axes(const Lattice& lattice, const std::string& path, long line) {
  const auto is_finite = [](Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  const auto& step = lattice.step;
  if (!is_finite(lattice.origin) || !is_finite(step[0]) || !is_finite(step[1]) || !is_finite(step[2])) {
    throw FormatError(path, line, "origin or grid steps are not finite numbers");
  }
  constexpr double kFlat = 1e-6;
  const double lengths = norm(step[0]) * norm(step[1]) * norm(step[2]);
  const double volume = std::abs(dot(step[0], cross(step[1], step[2])));
  if (lengths > 0 && volume > kFlat * lengths) return;
  throw FormatError(path, line,
                    lengths > 0 ? "the three grid axes lie in one plane; they must span a volume"
                                : "a grid step is zero; the three axes must have a length");
}

void check_size_promise(std::size_t n_values, std::size_t least_bytes, std::size_t bytes_left, const std::string& path,
                        long line) {
  if (least_bytes <= bytes_left) return;
  throw FormatError(path, line,
                    "the header promises " + std::to_string(n_values) + " values, but only " +
                        std::to_string(bytes_left) + " bytes follow; the file is cut short or its counts are wrong");
}

void allocate_values(Grid& grid) {
  require_memory(static_cast<double>(grid.lattice.n_points()) * sizeof(float), grid.name);
  try {
    grid.values.resize(grid.lattice.n_points());
  } catch (const std::bad_alloc&) {
    throw MemoryError(grid.name + ": " + std::to_string(grid.lattice.n_points()) +
                      " grid values do not fit into memory; crop or coarsen the map");
  }
}

}  // namespace espdiff
