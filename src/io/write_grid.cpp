// write_grid.cpp: OpenDX text from a grid.
#include "io/write_grid.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <ostream>

#include "base/error.h"
#include "io/atomic_file.h"

namespace espdiff {
namespace {

void check_grid(const std::string& path, const Grid& grid) {
  const std::size_t n_points = grid.lattice.n_points();
  if (n_points == 0 || grid.values.size() != n_points) {
    throw InputError(path + ": not written: the grid has " + std::to_string(n_points) + " points but " +
                     std::to_string(grid.values.size()) + " values");
  }
  for (std::size_t i = 0; i < n_points; ++i) {
    if (std::isfinite(grid.values[i])) continue;
    throw InputError(path + ": not written: value " + std::to_string(i) + " of the map is not a finite number");
  }
}

/// Shortest of up to `digits` significant digits; independent of the locale.
std::string number(double value, int digits) {
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
  return {buffer, result.ptr};
}

std::string vector_line(const char* keyword, Vec3d v) {
  constexpr int kDigits = 12;
  return std::string(keyword) + ' ' + number(v.x, kDigits) + ' ' + number(v.y, kDigits) + ' ' + number(v.z, kDigits) +
         '\n';
}

void write_header(std::ostream& out, const Grid& grid) {
  const auto& size = grid.lattice.size;
  const std::string counts = std::to_string(size[0]) + ' ' + std::to_string(size[1]) + ' ' + std::to_string(size[2]);
  out << "# written by espdiff\n";
  if (grid.unit != PotentialUnit::kUnknown) out << "# POTENTIAL (" << to_string(grid.unit) << ")\n";
  out << "object 1 class gridpositions counts " << counts << '\n' << vector_line("origin", grid.lattice.origin);
  for (const Vec3d& step : grid.lattice.step) out << vector_line("delta", step);
  out << "object 2 class gridconnections counts " << counts << '\n'
      << "object 3 class array type double rank 0 items " << grid.values.size() << " data follows\n";
}

void write_values(std::ostream& out, const Grid& grid) {
  constexpr int kDigits = 9, kPerLine = 3;
  const auto [nx, ny, nz] = grid.lattice.size;
  const std::ptrdiff_t column = nx, row = ny;
  std::string line;
  std::size_t n_written = 0;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (int k = 0; k < nz; ++k) {
        const auto index = static_cast<std::size_t>(i + column * (j + row * k));
        line += number(static_cast<double>(grid.values[index]), kDigits);
        ++n_written;
        const bool ends_line = n_written % kPerLine == 0 || n_written == grid.values.size();
        line += ends_line ? '\n' : ' ';
        if (!ends_line) continue;
        out << line;
        line.clear();
      }
    }
  }
}

}  // namespace

void write_dx(const std::string& path, const Grid& grid) {
  check_grid(path, grid);
  AtomicFile file(path);
  write_header(file.stream(), grid);
  write_values(file.stream(), grid);
  file.stream() << "attribute \"dep\" string \"positions\"\n"
                   "object \"regular positions regular connections\" class field\n"
                   "component \"positions\" value 1\n"
                   "component \"connections\" value 2\n"
                   "component \"data\" value 3\n";
  file.commit();
}

}  // namespace espdiff
