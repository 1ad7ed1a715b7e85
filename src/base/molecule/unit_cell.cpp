// unit_cell.cpp: edge vectors from lengths and angles.
#include "base/molecule/unit_cell.h"

#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/formatted.h"

namespace espdiff {

namespace {

/// Edge vectors by lengths and angles; nothing where no cell has such angles.
std::optional<std::array<Vec3d, 3>> find_edges(const UnitCell& cell) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  // Right angles are exact: the cosine of 90 degrees in radians is not zero.
  const auto cosine = [](double angle) { return angle == 90 ? 0.0 : std::cos(angle * kDegree); };
  const double cos_bc = cosine(cell.angles.x), cos_ac = cosine(cell.angles.y), cos_ab = cosine(cell.angles.z);
  const double sin_ab = cell.angles.z == 90 ? 1.0 : std::sin(cell.angles.z * kDegree);
  const double y = sin_ab > 0 ? (cos_bc - cos_ac * cos_ab) / sin_ab : 2, z_square = 1 - cos_ac * cos_ac - y * y;
  if (!(z_square > 0)) return std::nullopt;
  const Vec3d& l = cell.lengths;
  return std::array<Vec3d, 3>{Vec3d{l.x, 0, 0}, Vec3d{l.y * cos_ab, l.y * sin_ab, 0},
                              Vec3d{l.z * cos_ac, l.z * y, l.z * std::sqrt(z_square)}};
}

}  // namespace

bool can_be(const UnitCell& cell) { return find_edges(cell).has_value(); }

std::array<Vec3d, 3> edges_of(const UnitCell& cell) {
  const auto edges = find_edges(cell);
  if (edges) return *edges;
  throw InputError("no cell has the angles " + formatted(cell.angles.x) + ", " + formatted(cell.angles.y) + " and " +
                   formatted(cell.angles.z) + " degrees; correct the file's CRYST1 record, or give the cell's edges");
}

}  // namespace espdiff
