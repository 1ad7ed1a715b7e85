// map_drawings.cpp: isopotential surfaces and slices with VTK's filters.
#include "view/drawings/map_drawings.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>

#include "scene/map_sampling.h"

namespace espdiff {
namespace {

/// The map as an image in lattice coordinates, since VTK's filters do not support skewed axes.
vtkNew<vtkImageData> image_of(const Grid& map) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(map.lattice.size[0], map.lattice.size[1], map.lattice.size[2]);
  vtkNew<vtkFloatArray> values;
  // The filter only reads, but VTK's interface is not const.
  values->SetArray(const_cast<float*>(map.values.data()), static_cast<vtkIdType>(map.values.size()), 1);
  image->GetPointData()->SetScalars(values);
  return image;
}

vtkSmartPointer<vtkActor> actor_of(vtkPolyDataMapper* mapper) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetInterpolationToPhong();
  actor->GetProperty()->SetAmbient(0.3);
  actor->GetProperty()->SetDiffuse(0.8);
  return actor;
}

}  // namespace

Vec3d PlacedMap::in_map(Vec3d p) const {
  const Vec3d offset = p - to_frame.translation;
  const double* r = to_frame.rotation;
  return {r[0] * offset.x + r[3] * offset.y + r[6] * offset.z, r[1] * offset.x + r[4] * offset.y + r[7] * offset.z,
          r[2] * offset.x + r[5] * offset.y + r[8] * offset.z};
}

vtkSmartPointer<vtkProp> make_isopotential(const PlacedMap& map, double value, const ColourScale& scale) {
  vtkNew<vtkImageData> image = image_of(*map.map);
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetValue(0, value);
  contour->ComputeNormalsOff();
  contour->ComputeScalarsOff();
  contour->Update();
  vtkPolyData* shape = contour->GetOutput();
  if (shape->GetNumberOfPolys() == 0) return nullptr;
  const Lattice& lattice = map.map->lattice;
  for (vtkIdType i = 0; i < shape->GetNumberOfPoints(); ++i) {
    double index[3];
    shape->GetPoint(i, index);
    const Vec3d p = map.to_frame.apply(lattice.origin + index[0] * lattice.step[0] + index[1] * lattice.step[1] +
                                       index[2] * lattice.step[2]);
    shape->GetPoints()->SetPoint(i, p.x, p.y, p.z);
  }
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(shape);
  normals->SplittingOff();
  normals->ConsistencyOff();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(normals->GetOutputPort());
  mapper->ScalarVisibilityOff();
  const auto actor = actor_of(mapper);
  const Rgb colour = scale.colour(static_cast<float>(value));
  actor->GetProperty()->SetColor(colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
  actor->GetProperty()->SetOpacity(0.35);
  return actor;
}

vtkSmartPointer<vtkProp> make_slice(const PlacedMap& map, const CameraView& view, double radius_A, double depth,
                                    const ColourScale& scale) {
  constexpr vtkIdType kCells = 400;
  const Vec3d right = cross(view.up, view.toward_viewer);
  const Vec3d middle = view.centre + ((1 - 2 * depth) * radius_A) * view.toward_viewer;
  const LatticeIndex index(map.map->lattice, map.map->name);
  vtkNew<vtkPoints> points;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  std::vector<bool> has_value;
  for (vtkIdType j = 0; j <= kCells; ++j) {
    for (vtkIdType i = 0; i <= kCells; ++i) {
      const double x = (2.0 * static_cast<double>(i) / kCells - 1) * radius_A;
      const double y = (2.0 * static_cast<double>(j) / kCells - 1) * radius_A;
      const Vec3d p = middle + x * right + y * view.up;
      const float value = sample_at(*map.map, index(map.in_map(p)));
      const Rgb colour = scale.colour(value);
      points->InsertNextPoint(p.x, p.y, p.z);
      colours->InsertNextTuple3(colour.red, colour.green, colour.blue);
      has_value.push_back(std::isfinite(value));
    }
  }
  vtkNew<vtkCellArray> cells;
  for (vtkIdType j = 0; j < kCells; ++j) {
    for (vtkIdType i = 0; i < kCells; ++i) {
      const vtkIdType a = j * (kCells + 1) + i, b = a + 1, c = b + kCells + 1, d = c - 1;
      bool all = true;
      for (const vtkIdType corner : {a, b, c, d}) all = all && has_value[static_cast<std::size_t>(corner)];
      if (all) cells->InsertNextCell({a, b, c, d});
    }
  }
  if (cells->GetNumberOfCells() == 0) return nullptr;
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(points);
  shape->SetPolys(cells);
  shape->GetPointData()->SetScalars(colours);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(shape);
  const auto actor = actor_of(mapper);
  actor->GetProperty()->LightingOff();
  return actor;
}

vtkSmartPointer<vtkProp> make_field_lines(const PlacedMap& map, const std::vector<std::vector<Vec3d>>& lines,
                                          const ColourScale& scale) {
  const LatticeIndex index(map.map->lattice, map.map->name);
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  for (const std::vector<Vec3d>& line : lines) {
    cells->InsertNextCell(static_cast<int>(line.size()));
    for (const Vec3d& p : line) {
      cells->InsertCellPoint(points->InsertNextPoint(p.x, p.y, p.z));
      const Rgb colour = scale.colour(sample_at(*map.map, index(map.in_map(p))));
      colours->InsertNextTuple3(colour.red, colour.green, colour.blue);
    }
  }
  if (cells->GetNumberOfCells() == 0) return nullptr;
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(points);
  shape->SetLines(cells);
  shape->GetPointData()->SetScalars(colours);
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(shape);
  tubes->SetRadius(0.12);
  tubes->SetNumberOfSides(8);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tubes->GetOutputPort());
  return actor_of(mapper);
}

}  // namespace espdiff
