// field_lines.cpp: traces field lines of a potential map outside a surface.
#include "view/drawings/field_lines.h"

#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticPointLocator.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/map_sampling.h"
#include "view/drawings/map_drawings.h"

namespace espdiff {
namespace {

constexpr double kStep_A = 0.25, kLongest_A = 60, kLinesApart_A = 4;
/// Step of the gradient's central differences.
constexpr double kReach_A = 0.25;
/// Depth below the surface at which a line ends; it starts on the surface.
constexpr double kDepth_A = 0.3;

class Field {
 public:
  explicit Field(const PlacedMap& map) : map_(map), index_(map.map->lattice, map.map->name) {}

  /// -grad of the potential in the picture's frame; empty at the border and outside.
  std::optional<Vec3d> at(Vec3d place) const {
    const Vec3d p = map_.in_map(place);
    Vec3d field{};
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d offset{};
      offset[axis] = kReach_A;
      const double slope = (value(p + offset) - value(p - offset)) / (2 * kReach_A);
      if (!std::isfinite(slope)) return std::nullopt;
      field[axis] = -slope;
    }
    return map_.turned(field);
  }

 private:
  double value(Vec3d p) const { return sample_at(*map_.map, index_(p)); }

  PlacedMap map_;
  LatticeIndex index_;
};

/// Tests for inside by the nearest vertex.
class Inside {
 public:
  Inside(const std::vector<Vec3d>& positions, const std::vector<Vec3f>& normals)
      : positions_(positions), normals_(normals) {
    vtkNew<vtkPoints> points;
    for (const Vec3d& p : positions) points->InsertNextPoint(p.x, p.y, p.z);
    shape_->SetPoints(points);
    locator_->SetDataSet(shape_);
    locator_->BuildLocator();
  }

  bool operator()(Vec3d p) const {
    const double place[3] = {p.x, p.y, p.z};
    const auto nearest = static_cast<std::size_t>(locator_->FindClosestPoint(place));
    return dot(p - positions_[nearest], static_cast<Vec3d>(normals_[nearest])) < -kDepth_A;
  }

 private:
  const std::vector<Vec3d>& positions_;
  const std::vector<Vec3f>& normals_;
  vtkNew<vtkPolyData> shape_;
  vtkNew<vtkStaticPointLocator> locator_;
};

/// The next point of a line, one step in the field's direction.
std::optional<Vec3d> step(const Field& field, Vec3d p, double sign) {
  const auto direction = [&](Vec3d place) -> std::optional<Vec3d> {
    const std::optional<Vec3d> e = field.at(place);
    if (!e || !(norm(*e) > 1e-6)) return std::nullopt;
    return (sign / norm(*e)) * *e;
  };
  const auto k1 = direction(p);
  const auto k2 = k1 ? direction(p + (kStep_A / 2) * *k1) : k1;
  const auto k3 = k2 ? direction(p + (kStep_A / 2) * *k2) : k2;
  const auto k4 = k3 ? direction(p + kStep_A * *k3) : k3;
  if (!k4) return std::nullopt;
  return p + (kStep_A / 6) * (*k1 + 2.0 * *k2 + 2.0 * *k3 + *k4);
}

std::vector<Vec3d> trace(const Field& field, const Inside& is_inside, Vec3d start, double sign) {
  std::vector<Vec3d> line;
  Vec3d p = start;
  for (double length = 0; length < kLongest_A; length += kStep_A) {
    const std::optional<Vec3d> next = step(field, p, sign);
    if (!next || is_inside(*next)) break;
    line.push_back(*next);
    p = *next;
  }
  return line;
}

std::vector<Vec3d> choose_starts(const Field& field, const std::vector<Vec3d>& positions, int n) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (const auto e = field.at(positions[i])) order.emplace_back(-norm(*e), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<Vec3d> starts;
  for (const auto& [strength, i] : order) {
    if (static_cast<int>(starts.size()) == n) break;
    const Vec3d p = positions[i];
    const bool crowds = std::any_of(starts.begin(), starts.end(), [&](Vec3d s) { return norm(s - p) < kLinesApart_A; });
    if (!crowds) starts.push_back(p);
  }
  return starts;
}

}  // namespace

std::vector<std::vector<Vec3d>> trace_field_lines(const PlacedMap& map, const std::vector<Vec3d>& positions,
                                                  const std::vector<Vec3f>& normals, int n_lines) {
  const Field field(map);
  const Inside is_inside(positions, normals);
  std::vector<std::vector<Vec3d>> lines;
  for (const Vec3d& start : choose_starts(field, positions, n_lines)) {
    std::vector<Vec3d> line = trace(field, is_inside, start, -1);
    std::reverse(line.begin(), line.end());
    line.push_back(start);
    const std::vector<Vec3d> onward = trace(field, is_inside, start, 1);
    line.insert(line.end(), onward.begin(), onward.end());
    constexpr std::size_t kFewestPoints = 8;
    if (line.size() >= kFewestPoints) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace espdiff
