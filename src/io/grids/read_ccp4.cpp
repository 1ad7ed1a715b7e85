// read_ccp4.cpp: header and values of CCP4 and MRC files.
#include "io/grids/read_ccp4.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "io/grids/grid_checks.h"
#include "io/grids/grid_format.h"

namespace espdiff {
namespace {

constexpr std::size_t kHeaderBytes = 1024;
constexpr double kDegree = 3.14159265358979323846 / 180;

/// Numbers of either byte order.
class Words {
 public:
  explicit Words(std::string_view bytes) : bytes_(bytes) {
    const auto stamp = static_cast<unsigned char>(bytes[212]);
    swaps_ = stamp == 0x11;
  }

  template <typename T>
  T at(std::size_t byte) const {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes_.data() + byte, sizeof(T));
    if (swaps_) std::reverse(raw.begin(), raw.end());
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }
  /// Word `number` of the header, from 1 as its description counts.
  std::int32_t whole(std::size_t number) const { return at<std::int32_t>(4 * (number - 1)); }
  double real(std::size_t number) const { return static_cast<double>(at<float>(4 * (number - 1))); }

 private:
  std::string_view bytes_;
  bool swaps_;
};

/// The edges of the unit cell: a along x, b in the plane of x and y.
std::array<Vec3d, 3> cell_edges(const Words& head, const std::string& path) {
  const double a = head.real(11), b = head.real(12), c = head.real(13), cos_alpha = std::cos(head.real(14) * kDegree),
               cos_beta = std::cos(head.real(15) * kDegree), gamma = head.real(16) * kDegree;
  if (!(a > 0 && b > 0 && c > 0 && std::sin(gamma) > 0)) throw FormatError(path, 0, "its unit cell has no volume");
  const double y = (cos_alpha - cos_beta * std::cos(gamma)) / std::sin(gamma),
               z = std::sqrt(std::max(0.0, 1 - cos_beta * cos_beta - y * y));
  return {{{a, 0, 0}, {b * std::cos(gamma), b * std::sin(gamma), 0}, {c * cos_beta, c * y, c * z}}};
}

/// [column, row, section] the axis of each, 0 to 2.
std::array<std::size_t, 3> axes_of(const Words& head, const std::string& path) {
  std::array<std::size_t, 3> axes{};
  std::array<int, 3> n_uses{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t axis = head.whole(17 + i);
    if (axis < 1 || axis > 3 || ++n_uses[static_cast<std::size_t>(axis - 1)] > 1)
      throw FormatError(path, 0, "its axes (words 17 to 19) are not 1, 2 and 3 in some order");
    axes[i] = static_cast<std::size_t>(axis - 1);
  }
  return axes;
}

std::size_t bytes_of(std::int32_t mode, const std::string& path) {
  switch (mode) {
    case 0: return 1;
    case 1:
    case 6: return 2;
    case 2: return 4;
    default: break;
  }
  throw FormatError(path, 0,
                    "its values are of mode " + std::to_string(mode) +
                        ", and 0, 1, 2 and 6 are read; save it with 32-bit floats (mode 2)");
}

float value_of(const Words& file, std::int32_t mode, std::size_t byte) {
  if (mode == 0) return static_cast<float>(file.at<std::int8_t>(byte));
  if (mode == 1) return static_cast<float>(file.at<std::int16_t>(byte));
  return mode == 6 ? static_cast<float>(file.at<std::uint16_t>(byte)) : file.at<float>(byte);
}

}  // namespace

Grid read_ccp4(const std::string& path, std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) throw FormatError(path, 0, "it ends within the header of a CCP4 map");
  const Words file(bytes);
  const auto axes = axes_of(file, path);
  const auto edges = cell_edges(file, path);
  const std::int32_t mode = file.whole(4), n_symmetry_bytes = file.whole(24);
  const std::size_t width = bytes_of(mode, path);
  const auto n = check_counts({file.whole(1), file.whole(2), file.whole(3)}, path, 0);
  Grid grid;
  grid.name = path;
  std::array<int, 3> start{}, intervals{};
  bool is_whole = file.whole(23) > 0;
  for (std::size_t i = 0; i < 3; ++i) {
    grid.lattice.size[axes[i]] = n[i];
    start[axes[i]] = file.whole(5 + i);
    intervals[i] = file.whole(8 + i);
    if (intervals[i] < 1) throw FormatError(path, 0, "its unit cell has no intervals (words 8 to 10)");
  }
  const Vec3d origin{file.real(50), file.real(51), file.real(52)};
  const bool has_origin = norm(origin) > 0;
  grid.lattice.origin = origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.lattice.step[axis] = 1.0 / intervals[axis] * edges[axis];
    if (!has_origin) grid.lattice.origin += static_cast<double>(start[axis]) * grid.lattice.step[axis];
    is_whole = is_whole && grid.lattice.size[axis] == intervals[axis];
  }
  grid.periodic = is_whole && !has_origin;
  check_axes(grid.lattice, path, 0);
  const std::size_t first = kHeaderBytes + static_cast<std::size_t>(std::max(0, n_symmetry_bytes));
  check_size_promise(grid.lattice.n_points(), width * grid.lattice.n_points(),
                     bytes.size() < first ? 0 : bytes.size() - first, path, 0);
  allocate_values(grid);
  std::array<std::size_t, 3> at{};  // column, row, section
  const std::size_t columns = static_cast<std::size_t>(n[0]), rows = static_cast<std::size_t>(n[1]);
  const auto& size = grid.lattice.size;
  for (std::size_t p = 0; p < grid.lattice.n_points(); ++p) {
    at = {p % columns, p / columns % rows, p / columns / rows};
    std::array<std::size_t, 3> index{};
    for (std::size_t i = 0; i < 3; ++i) index[axes[i]] = at[i];
    const float value = value_of(file, mode, first + p * width);
    if (!std::isfinite(value)) throw FormatError(path, 0, "value " + std::to_string(p + 1) + " is not finite");
    grid.values[index[0] +
                static_cast<std::size_t>(size[0]) * (index[1] + static_cast<std::size_t>(size[1]) * index[2])] = value;
  }
  return grid;
}

GridFormat ccp4_format() {
  return {"CCP4", [](std::string_view, FileKind kind) { return kind == FileKind::kCcp4; },
          [](FileContent file, const GridOptions& /*options*/) { return read_ccp4(file.path, file.content); }};
}

}  // namespace espdiff
