// pick.cpp: intersects a line with the surface and interpolates the values of its corners and the maps.
#include "view/window/pick.h"

#include <vtkCellArray.h>
#include <vtkPoints.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/formatted.h"
#include "scene/map_sampling.h"
#include "view/drawings/residue_labels.h"

namespace espdiff {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// Barycentric weights of a point in a triangle's plane.
std::array<double, 3> weights_at(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d normal = cross(b - a, c - a);
  const double area = dot(normal, normal);
  if (!(area > 0)) return {1, 0, 0};
  const double of_a = dot(cross(c - b, p - b), normal) / area, of_b = dot(cross(a - c, p - c), normal) / area;
  return {of_a, of_b, 1 - of_a - of_b};
}

float interpolated(const std::vector<float>& values, const Triangle& t, const std::array<double, 3>& weights) {
  if (values.empty()) return kNothing;
  return static_cast<float>(weights[0] * values[t[0]] + weights[1] * values[t[1]] + weights[2] * values[t[2]]);
}

Vec3d interpolated(const std::vector<Vec3d>& places, const Triangle& t, const std::array<double, 3>& weights) {
  return weights[0] * places[t[0]] + weights[1] * places[t[1]] + weights[2] * places[t[2]];
}

float looked_up(const Grid& map, Vec3d place) { return sample_at(map, LatticeIndex(map.lattice, map.name)(place)); }

std::string line(const char* what, const std::string& says) { return formatted("%-17s ", what) + says; }

std::string number(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "no value";
  return formatted("%.3f", value) + (unit.empty() ? "" : " " + unit);
}

/// By the codes of the array `why`.
const char* reason_of(int why) {
  switch (why) {
    case 3: return "its residue has no partner";
    case 4: return "it slipped by more than 3 A from its own atoms";
    case 5: return "it lies on another residue than the paired one";
    case 6: return "its residue's difference is not that of its own surfaces";
    case 7: return "it has no potential";
    default: return "the triangle is off the target's surface";
  }
}

std::string trust(const PickedPoint& point) {
  if (!point.is_matched) return "unmatched: no place on the target";
  if (point.is_untrusted) return std::string("not trusted here: ") + reason_of(point.why);
  return "trusted here";
}

}  // namespace

Vec3d SurfacePicker::vertex(std::size_t i, double morph) const {
  return (1 - morph) * static_cast<Vec3d>(start_.positions[i]) + morph * files_.surface.positions[i];
}

void SurfacePicker::prepare(double morph) {
  if (prepared_ == morph) return;
  const SurfaceFile& surface = files_.surface;
  vtkNew<vtkPoints> points;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vec3d p = vertex(i, morph);
    points->InsertNextPoint(p.x, p.y, p.z);
  }
  vtkNew<vtkCellArray> cells;
  triangles_.clear();
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    if (morph > 0 && !surface.is_matched(i)) continue;
    const Triangle& t = surface.triangles[i];
    cells->InsertNextCell({static_cast<vtkIdType>(t[0]), static_cast<vtkIdType>(t[1]), static_cast<vtkIdType>(t[2])});
    triangles_.push_back(i);
  }
  shape_->SetPoints(points);
  shape_->SetPolys(cells);
  shape_->DeleteCells();
  shape_->BuildCells();
  locator_->SetDataSet(shape_);
  shape_->Modified();
  locator_->BuildLocator();
  prepared_ = morph;
}

std::optional<PickedPoint> SurfacePicker::pick(Vec3d from, Vec3d to, double morph) {
  prepare(morph);
  const double a[3] = {from.x, from.y, from.z}, b[3] = {to.x, to.y, to.z};
  double share = 0, place[3], local[3];
  int part = 0;
  vtkIdType cell = -1;
  if (locator_->IntersectWithLine(a, b, 1e-6, share, place, local, part, cell) == 0 || cell < 0) return std::nullopt;
  const std::size_t triangle = triangles_[static_cast<std::size_t>(cell)];
  const Triangle& t = files_.surface.triangles[triangle];
  return describe(triangle, weights_at({place[0], place[1], place[2]}, vertex(t[0], morph), vertex(t[1], morph),
                                       vertex(t[2], morph)));
}

Vec3d SurfacePicker::place(const PickedPoint& point, double morph) const {
  const Triangle& t = files_.surface.triangles[point.triangle];
  return point.weights[0] * vertex(t[0], morph) + point.weights[1] * vertex(t[1], morph) +
         point.weights[2] * vertex(t[2], morph);
}

PickedPoint SurfacePicker::describe(std::size_t triangle, std::array<double, 3> weights) const {
  const SurfaceFile& surface = files_.surface;
  const Triangle& t = surface.triangles[triangle];
  PickedPoint point;
  point.triangle = triangle;
  point.weights = weights;
  point.is_untrusted = surface.is_untrusted(triangle);
  point.is_matched = surface.is_matched(triangle);
  point.why = surface.why.empty() ? 0 : surface.why[triangle];
  point.from_maps = files_.maps.complete();
  if (point.from_maps) {
    point.source = looked_up(*files_.maps.source, interpolated(surface.source_positions, t, weights));
    point.target = looked_up(*files_.maps.target, interpolated(surface.positions, t, weights));
  } else {
    point.source = interpolated(surface.potential_source, t, weights);
    point.target = interpolated(surface.potential_target, t, weights);
  }
  if (!point.is_matched) point.target = kNothing;
  point.displacement_A = point.is_matched ? interpolated(surface.displacement, t, weights) : kNothing;
  point.slip_A = point.is_matched && !surface.slip.empty() ? interpolated(surface.slip, t, weights) : kNothing;
  const std::size_t nearest =
      t[static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin())];
  if (!surface.residue_index.empty()) point.residue = static_cast<int>(surface.residue_index[nearest]);
  if (!surface.residue_number.empty()) point.residue_number = static_cast<int>(surface.residue_number[nearest]);
  return point;
}

std::vector<std::string> picked_in_words(const PickedPoint& point, const ComparisonFiles& files,
                                         const std::string& unit) {
  std::vector<std::string> lines;
  const bool named = files.source_molecule && point.residue >= 0;
  const std::string residue = named               ? residue_name(*files.source_molecule, point.residue)
                              : point.residue < 0 ? "none"
                                                  : "number " + std::to_string(point.residue_number);
  lines.push_back(line("residue", residue + " of the source"));
  lines.push_back(line("source", number(point.source, unit)));
  lines.push_back(line("target", number(point.target, unit)));
  const double difference = static_cast<double>(point.target) - static_cast<double>(point.source);
  const bool changes = point.source * point.target < 0;
  lines.push_back(line("target - source", number(difference, unit) + (changes ? ", the sign changes" : "")));
  lines.push_back(line("slip", number(point.slip_A, "A") + " from where its atoms went"));
  lines.push_back(line("displacement", number(point.displacement_A, "A") + " to its counterpart"));
  lines.push_back(line("certificate", trust(point)));
  if (files.record.found) {
    std::string whole = files.record.verdict;
    for (const std::string& reason : files.record.reasons) whole += "; " + reason;
    lines.push_back(line("comparison", whole));
  }
  lines.push_back(line("potentials", point.from_maps ? "from the maps" : "interpolated between vertices"));
  return lines;
}

}  // namespace espdiff
