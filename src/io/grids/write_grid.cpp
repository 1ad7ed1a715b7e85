// write_grid.cpp: OpenDX text and VTI from a grid.
#include "io/grids/write_grid.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <ostream>
#include <string>

#include "base/error.h"
#include "io/files/atomic_file.h"
#include "io/vtk/vtk_encoding.h"

namespace espdiff {
namespace {

void check_grid(const std::string& path, const Grid& grid) {
  const std::size_t n_points = grid.lattice.n_points();
  if (n_points == 0 || grid.values.size() != n_points) {
    throw InputError(path + ": not written: the grid has " + std::to_string(n_points) + " points but " +
                     std::to_string(grid.values.size()) + " values");
  }
  const float* const values = grid.values.data();
  std::uint32_t n_others = 0;
  for (std::size_t i = 0; i < n_points; ++i) {  // by the exponent, which the compiler makes a loop of vectors of
    constexpr std::uint32_t kExponent = 0x7f800000;
    std::uint32_t bits = 0;
    std::memcpy(&bits, values + i, sizeof bits);
    n_others += (bits & kExponent) == kExponent ? 1 : 0;
  }
  if (n_others == 0) return;
  const auto first = std::find_if(values, values + n_points, [](float v) { return !std::isfinite(v); });
  throw InputError(path + ": not written: value " + std::to_string(first - values) +
                   " of the map is not a finite number");
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

void write_dx_content(std::ostream& out, const Grid& grid) {
  write_header(out, grid);
  write_values(out, grid);
  out << "attribute \"dep\" string \"positions\"\n"
         "object \"regular positions regular connections\" class field\n"
         "component \"positions\" value 1\n"
         "component \"connections\" value 2\n"
         "component \"data\" value 3\n";
}

/// Numbers of full precision, separated by blanks.
std::string vti_numbers(std::initializer_list<double> values) {
  constexpr int kDigits = 17;
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + number(value, kDigits);
  return text;
}

void write_vti_content(std::ostream& out, const Grid& grid) {
  const Lattice& lattice = grid.lattice;
  const double length[3] = {norm(lattice.step[0]), norm(lattice.step[1]), norm(lattice.step[2])};
  const Vec3d a = (1 / length[0]) * lattice.step[0], b = (1 / length[1]) * lattice.step[1],
              c = (1 / length[2]) * lattice.step[2];
  std::string extent;
  for (const int n : lattice.size) extent += (extent.empty() ? "0 " : " 0 ") + std::to_string(n - 1);
  const Vec3d& o = lattice.origin;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"" << vtk_byte_order()
      << "\" header_type=\"UInt64\">\n  <ImageData WholeExtent=\"" << extent << "\" Origin=\""
      << vti_numbers({o.x, o.y, o.z}) << "\" Spacing=\"" << vti_numbers({length[0], length[1], length[2]})
      << "\" Direction=\"" << vti_numbers({a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z}) << "\">\n    <FieldData>\n"
      << "      <Array type=\"String\" Name=\"unit\" NumberOfTuples=\"1\" format=\"ascii\">";
  for (const char letter : to_string(grid.unit)) out << static_cast<int>(letter) << ' ';
  out << "0</Array>\n    </FieldData>\n    <Piece Extent=\"" << extent
      << "\">\n      <PointData Scalars=\"potential\">\n        <DataArray type=\"Float32\" Name=\"potential\" "
         "format=\"appended\" offset=\"0\"/>\n      </PointData>\n    </Piece>\n  </ImageData>\n"
      << "  <AppendedData encoding=\"raw\">\n_";
  const std::uint64_t n_bytes = grid.values.size() * sizeof(float);
  out.write(reinterpret_cast<const char*>(&n_bytes), sizeof n_bytes);
  out.write(reinterpret_cast<const char*>(grid.values.data()), static_cast<std::streamsize>(n_bytes));
  out << "\n  </AppendedData>\n</VTKFile>\n";
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

void write_dx(AtomicFile& file, const Grid& grid) {
  check_grid(file.path(), grid);
  write_dx_content(file.stream(), grid);
}

void write_dx(const std::string& path, const Grid& grid) {
  AtomicFile file(path);
  write_dx(file, grid);
  file.commit();
}

void write_vti(const std::string& path, const Grid& grid) {
  check_grid(path, grid);
  AtomicFile file(path);
  write_vti_content(file.stream(), grid);
  file.commit();
}

void write_vti(std::ostream& out, const Grid& grid) {
  check_grid(grid.name, grid);
  write_vti_content(out, grid);
}

void check_map_ending(const std::string& path) {
  if (ends_with(path, ".dx") || ends_with(path, ".vti")) return;
  throw InputError(path + ": maps are written as OpenDX or VTI; give a name that ends in .dx or .vti");
}

void write_map(AtomicFile& file, const Grid& grid) {
  check_map_ending(file.path());
  check_grid(file.path(), grid);
  if (ends_with(file.path(), ".vti")) {
    write_vti_content(file.stream(), grid);
  } else {
    write_dx_content(file.stream(), grid);
  }
}

}  // namespace espdiff
