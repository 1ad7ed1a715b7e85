// target_surface.cpp: flying edges over a sum of Gaussians, and VTK's cell locator.
#include "verify/target_surface.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkStaticCellLocator.h>
#include <vtkTriangle.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"

namespace espdiff {
namespace {

/// Gaussians end at 4.5 widths (docs/reading.md, ARCHITECTURE.md).
constexpr double kReachInWidths = 4.5;

/// Six times the volume that a closed component encloses; negative for a cavity.
double signed_volume(vtkPolyData* surface) {
  double sum = 0;
  vtkNew<vtkIdList> corners;
  for (vtkIdType t = 0; t < surface->GetNumberOfCells(); ++t) {
    surface->GetCellPoints(t, corners);
    Vec3d p[3];
    for (int k = 0; k < 3; ++k) {
      double x[3];
      surface->GetPoint(corners->GetId(k), x);
      p[k] = {x[0], x[1], x[2]};
    }
    sum += dot(p[0], cross(p[1], p[2]));
  }
  return sum;
}

}  // namespace

GaussianAtoms::GaussianAtoms(const std::vector<Vec3d>& positions, const std::vector<double>& widths) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!(widths[i] > 0)) continue;
    positions_.push_back(positions[i]);
    widths_.push_back(widths[i]);
    kept_.push_back(i);
    reach_ = std::max(reach_, kReachInWidths * widths[i]);
  }
  if (positions_.empty()) throw InputError("verify: no atom has a radius, so that there is no surface");
  lower_ = upper_ = positions_.front();
  for (const Vec3d& p : positions_) {
    for (int axis = 0; axis < 3; ++axis) {
      lower_[axis] = std::min(lower_[axis], p[axis]);
      upper_[axis] = std::max(upper_[axis], p[axis]);
    }
  }
  // Three cells a reach: smaller ones hold fewer atoms that are out of it.
  for (int axis = 0; axis < 3; ++axis)
    size_[axis] = std::min<std::size_t>(200, static_cast<std::size_t>(3 * (upper_[axis] - lower_[axis]) / reach_) + 1);
  cells_.resize(size_[0] * size_[1] * size_[2]);
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const Vec3d& p = positions_[i];
    cells_[cell_of(p, 0) + size_[0] * (cell_of(p, 1) + size_[1] * cell_of(p, 2))].push_back(i);
  }
}

std::size_t GaussianAtoms::cell_of(const Vec3d& p, int axis) const {
  const double extent = std::max(upper_[axis] - lower_[axis], 1e-9);
  const double place = (p[axis] - lower_[axis]) / extent * static_cast<double>(size_[axis]);
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(size_[axis] - 1)));
}

template <typename Visit>
void GaussianAtoms::visit(const Vec3d& p, Visit visit) const {
  CancelRequest().check();
  std::size_t low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d a = p, b = p;
    a[axis] -= reach_;
    b[axis] += reach_;
    low[axis] = cell_of(a, axis);
    high[axis] = cell_of(b, axis);
  }
  for (std::size_t z = low[2]; z <= high[2]; ++z) {
    for (std::size_t y = low[1]; y <= high[1]; ++y) {
      for (std::size_t x = low[0]; x <= high[0]; ++x) {
        for (const std::size_t i : cells_[x + size_[0] * (y + size_[1] * z)]) {
          const Vec3d d = p - positions_[i];
          const double s2 = widths_[i] * widths_[i], square = dot(d, d);
          if (square <= kReachInWidths * kReachInWidths * s2) visit(i, d, std::exp(-square / (2 * s2)));
        }
      }
    }
  }
}

double GaussianAtoms::at(const Vec3d& p, Vec3d& gradient) const {
  double sum = 0;
  gradient = {};
  visit(p, [&](std::size_t i, const Vec3d& d, double value) {
    sum += value;
    gradient += (-value / (widths_[i] * widths_[i])) * d;
  });
  return sum;
}

std::int32_t GaussianAtoms::strongest(const Vec3d& p, const std::vector<std::int32_t>& labels) const {
  std::map<std::int32_t, double> density;
  visit(p, [&](std::size_t i, const Vec3d&, double value) { density[labels[kept_[i]]] += value; });
  std::int32_t best = -1;
  double most = 0;
  for (const auto& [label, value] : density) {
    if (value <= most) continue;
    most = value;
    best = label;
  }
  return best;
}

vtkSmartPointer<vtkPolyData> GaussianAtoms::surface(double isovalue, double spacing_A) const {
  vtkNew<vtkImageData> image;
  int size[3];
  double origin[3];
  double n_points = 1;
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = lower_[axis] - reach_;
    const double n = std::ceil((upper_[axis] - lower_[axis] + 2 * reach_) / spacing_A) + 1;
    n_points *= n;
    size[axis] = n < std::numeric_limits<int>::max() ? static_cast<int>(n) : 0;
  }
  require_memory(n_points * sizeof(double), "verify: the target's surface");
  if (n_points > std::numeric_limits<int>::max())
    throw InputError("verify: the target's surface would need a lattice of more than 2^31 - 1 points");
  image->SetDimensions(size);
  image->SetOrigin(origin);
  image->SetSpacing(spacing_A, spacing_A, spacing_A);
  image->AllocateScalars(VTK_DOUBLE, 1);
  auto* const values = static_cast<double*>(image->GetScalarPointer());
  std::fill(values, values + image->GetNumberOfPoints(), 0.0);
  // Each atom adds to the points that it reaches.
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    CancelRequest().check();
    const double reach = kReachInWidths * widths_[i], s2 = widths_[i] * widths_[i];
    int low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = static_cast<int>(std::ceil((positions_[i][axis] - reach - origin[axis]) / spacing_A));
      high[axis] = static_cast<int>(std::floor((positions_[i][axis] + reach - origin[axis]) / spacing_A));
    }
    // A Gaussian is the product of its factors along the axes.
    std::vector<double> square[3], factor[3];
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = low[axis]; k <= high[axis]; ++k) {
        const double d = origin[axis] + spacing_A * k - positions_[i][axis];
        square[axis].push_back(d * d);
        factor[axis].push_back(std::exp(-d * d / (2 * s2)));
      }
    }
    for (std::size_t z = 0; z < square[2].size(); ++z) {
      for (std::size_t y = 0; y < square[1].size(); ++y) {
        const double left = reach * reach - square[1][y] - square[2][z], value = factor[1][y] * factor[2][z];
        const auto n = [](int k) { return static_cast<std::size_t>(k); };
        double* const row = values + n(low[0]) + n(size[0]) * (n(low[1]) + y + n(size[1]) * (n(low[2]) + z));
        for (std::size_t x = 0; x < square[0].size(); ++x)
          if (square[0][x] <= left) row[x] += factor[0][x] * value;
      }
    }
  }
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(image);
  edges->SetValue(0, isovalue);
  edges->ComputeNormalsOff();
  vtkNew<vtkPolyDataConnectivityFilter> parts;
  parts->SetInputConnection(edges->GetOutputPort());
  parts->SetExtractionModeToAllRegions();
  parts->Update();
  const int n_parts = parts->GetNumberOfExtractedRegions();
  // The orientation of the largest part tells outward; parts of the other sign are closed cavities.
  std::vector<vtkSmartPointer<vtkPolyData>> all;
  double largest = 0;
  for (int k = 0; k < n_parts; ++k) {
    parts->SetExtractionModeToSpecifiedRegions();
    parts->InitializeSpecifiedRegionList();
    parts->AddSpecifiedRegion(k);
    parts->Update();
    all.push_back(vtkSmartPointer<vtkPolyData>::New());
    all.back()->DeepCopy(parts->GetOutput());
    const double volume = signed_volume(all.back());
    if (std::fabs(volume) > std::fabs(largest)) largest = volume;
  }
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  vtkNew<vtkIdList> corners;
  for (const auto& part : all) {
    if (signed_volume(part) * largest < 0) continue;
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (vtkIdType p = 0; p < part->GetNumberOfPoints(); ++p) {
      double x[3];
      part->GetPoint(p, x);
      positions.push_back({x[0], x[1], x[2]});
    }
    for (vtkIdType t = 0; t < part->GetNumberOfCells(); ++t) {
      part->GetCellPoints(t, corners);
      Triangle triangle;
      for (vtkIdType k = 0; k < 3; ++k)
        triangle[static_cast<std::size_t>(k)] = first + static_cast<std::uint32_t>(corners->GetId(k));
      triangles.push_back(triangle);
    }
  }
  return polydata(positions, triangles);
}

vtkSmartPointer<vtkPolyData> polydata(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3d& p : positions) points->InsertNextPoint(p.x, p.y, p.z);
  vtkNew<vtkCellArray> cells;
  for (const Triangle& t : triangles) {
    const vtkIdType corners[3] = {t[0], t[1], t[2]};
    cells->InsertNextCell(3, corners);
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  return surface;
}

SurfaceDistances distances(vtkPolyData* from, vtkPolyData* to, double limit_A) {
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(to);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  const auto distance_of = [&](const double p[3]) {
    double nearest[3], square = 0, copy[3] = {p[0], p[1], p[2]};
    vtkIdType id = 0;
    int sub = 0;
    locator->FindClosestPoint(copy, nearest, cell, id, sub, square);
    return std::sqrt(square);
  };
  std::vector<double> at_corner(static_cast<std::size_t>(from->GetNumberOfPoints()));
  for (vtkIdType p = 0; p < from->GetNumberOfPoints(); ++p)
    at_corner[static_cast<std::size_t>(p)] = distance_of(from->GetPoint(p));
  std::vector<std::pair<double, double>> weighted;
  double all = 0, beyond = 0, within = 0;
  SurfaceDistances result;
  vtkNew<vtkIdList> corners;
  const auto add = [&](double distance, double weight) {
    weighted.emplace_back(distance, weight);
    all += weight;
    result.mean += weight * distance;
    result.max = std::max(result.max, distance);
    (distance > limit_A ? beyond : within) += distance > limit_A ? weight : weight * distance;
  };
  for (vtkIdType t = 0; t < from->GetNumberOfCells(); ++t) {
    CancelRequest().check();
    from->GetCellPoints(t, corners);
    double p[3][3], centre[3] = {0, 0, 0};
    for (vtkIdType k = 0; k < 3; ++k) {
      from->GetPoint(corners->GetId(k), p[k]);
      for (int axis = 0; axis < 3; ++axis) centre[axis] += p[k][axis] / 3;
    }
    const double area = vtkTriangle::TriangleArea(p[0], p[1], p[2]);
    for (vtkIdType k = 0; k < 3; ++k) add(at_corner[static_cast<std::size_t>(corners->GetId(k))], area / 12);
    add(distance_of(centre), 0.75 * area);
  }
  result.mean /= all;
  result.beyond = beyond / all;
  result.mean_within = all > beyond ? within / (all - beyond) : 0;
  std::sort(weighted.begin(), weighted.end());
  double below = 0;
  for (const auto& [distance, weight] : weighted) {
    result.p95 = distance;
    if ((below += weight) >= 0.95 * all) break;
  }
  return result;
}

double area_of(vtkPolyData* surface) {
  vtkNew<vtkMassProperties> properties;
  properties->SetInputData(surface);
  return properties->GetSurfaceArea();
}

}  // namespace espdiff
