// surface_file.cpp: reads a .vtp with VTK's reader and checks it.
#include "view/surface_file.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "view/vtk_messages.h"

namespace espdiff {
namespace {

std::string names_of(vtkPointData* arrays) {
  std::string names;
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) {
    const char* name = arrays->GetArrayName(i);
    if (name != nullptr) names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names.empty() ? "none" : names;
}

std::vector<float> scalars(vtkDataArray* array) {
  std::vector<float> values(static_cast<std::size_t>(array->GetNumberOfTuples()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<float>(array->GetComponent(static_cast<vtkIdType>(i), 0));
  }
  return values;
}

vtkDataArray* scalar_array(vtkFieldData* arrays, const char* name) {
  vtkDataArray* array = arrays->GetArray(name);
  return array != nullptr && array->GetNumberOfComponents() == 1 ? array : nullptr;
}

std::vector<Vec3f> normals_of(vtkPolyData* surface) {
  vtkDataArray* array = surface->GetPointData()->GetArray("normal");
  vtkNew<vtkPolyDataNormals> filter;
  if (array == nullptr || array->GetNumberOfComponents() != 3) {
    filter->SetInputData(surface);
    filter->SplittingOff();
    filter->ConsistencyOff();
    filter->Update();
    array = filter->GetOutput()->GetPointData()->GetNormals();
  }
  std::vector<Vec3f> normals(static_cast<std::size_t>(surface->GetNumberOfPoints()));
  if (array == nullptr) return normals;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    double normal[3];
    array->GetTuple(static_cast<vtkIdType>(i), normal);
    normals[i] = static_cast<Vec3f>(Vec3d{normal[0], normal[1], normal[2]});
  }
  return normals;
}

std::vector<Triangle> triangles_of(const std::string& path, vtkPolyData* surface) {
  const auto n_vertices = surface->GetNumberOfPoints();
  std::vector<Triangle> triangles;
  triangles.reserve(static_cast<std::size_t>(surface->GetNumberOfPolys()));
  vtkCellArray* cells = surface->GetPolys();
  vtkIdType n_corners = 0;
  const vtkIdType* corners = nullptr;
  for (cells->InitTraversal(); cells->GetNextCell(n_corners, corners) != 0;) {
    if (n_corners != 3) {
      throw FormatError(path, 0,
                        "a polygon has " + std::to_string(n_corners) + " corners; espdiff draws triangles only");
    }
    Triangle triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (corners[corner] < 0 || corners[corner] >= n_vertices) {
        throw FormatError(path, 0,
                          "a triangle refers to vertex " + std::to_string(corners[corner]) + " of " +
                              std::to_string(n_vertices) + "; write the file again");
      }
      triangle[corner] = static_cast<std::uint32_t>(corners[corner]);
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

void check_exists(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status))
    throw IoError(path, "no such file; `espdiff compare SOURCE TARGET -o OUT` writes OUT.vtp");
  if (std::filesystem::is_directory(status)) throw IoError(path, "is a directory; name the .vtp file in it");
}

/// [triangle] nonzero entries of a cell array; empty if the file has none of that name.
std::vector<std::uint8_t> flags_of(vtkPolyData* surface, const char* name) {
  vtkDataArray* array = scalar_array(surface->GetCellData(), name);
  std::vector<std::uint8_t> flags;
  if (array == nullptr || array->GetNumberOfTuples() != surface->GetNumberOfPolys()) return flags;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) flags.push_back(array->GetComponent(i, 0) != 0 ? 1 : 0);
  return flags;
}

/// [vertex] numbers of a point array; empty if the file has none of that name, or one of another length.
std::vector<float> numbers_of(vtkPolyData* surface, const char* name) {
  vtkDataArray* array = scalar_array(surface->GetPointData(), name);
  if (array == nullptr || array->GetNumberOfTuples() != surface->GetNumberOfPoints()) return {};
  return scalars(array);
}

std::string text_of(vtkPolyData* surface, const char* name) {
  auto* texts = vtkStringArray::SafeDownCast(surface->GetFieldData()->GetAbstractArray(name));
  return texts != nullptr && texts->GetNumberOfValues() > 0 ? std::string(texts->GetValue(0)) : std::string();
}

/// Empty if there is none with three components.
template <typename Vector>
std::vector<Vector> vectors_of(vtkPolyData* surface, const char* name) {
  vtkDataArray* array = surface->GetPointData()->GetArray(name);
  std::vector<Vector> vectors;
  if (array == nullptr || array->GetNumberOfComponents() != 3) return vectors;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
    double v[3];
    array->GetTuple(i, v);
    vectors.push_back(static_cast<Vector>(Vec3d{v[0], v[1], v[2]}));
  }
  return vectors;
}

std::vector<Vec3d> positions_of(const std::string& path, vtkPolyData* surface) {
  std::vector<Vec3d> positions(static_cast<std::size_t>(surface->GetNumberOfPoints()));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    double point[3];
    surface->GetPoint(static_cast<vtkIdType>(i), point);
    if (!std::isfinite(point[0] + point[1] + point[2])) {
      throw FormatError(path, 0,
                        "the position of vertex " + std::to_string(i) + " is not finite; write the file again");
    }
    positions[i] = {point[0], point[1], point[2]};
  }
  return positions;
}

void read_arrays(SurfaceFile& file, vtkPolyData* surface) {
  file.normals = normals_of(surface);
  file.source_positions = vectors_of<Vec3d>(surface, "source_position");
  file.source_normals = vectors_of<Vec3f>(surface, "source_normal");
  file.displacement = numbers_of(surface, "displacement");
  file.potential_source = numbers_of(surface, "potential_source");
  file.potential_target = numbers_of(surface, "potential_target");
  file.potential_difference = numbers_of(surface, "potential_difference");
  file.sign_change = numbers_of(surface, "sign_change");
  if (file.potential_difference.size() == file.sign_change.size()) {
    for (std::size_t i = 0; i < file.sign_change.size(); ++i) {
      if (std::isnan(file.potential_difference[i])) file.sign_change[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  file.residue_index = numbers_of(surface, "residue_index");
  file.residue_number = numbers_of(surface, "residue_number");
  // Lines or points would precede the polygons in cell data; espdiff writes none.
  file.corrupt = flags_of(surface, "corrupt");
  file.unmatched = flags_of(surface, "no_counterpart");
  file.potential_unit = text_of(surface, "potential_unit");
  file.written_by = text_of(surface, "written_by");
  file.array_names = names_of(surface->GetPointData());
}

}  // namespace

const std::vector<float>& SurfaceFile::values(RenderArray array) const {
  static const std::vector<float> nothing;
  const auto pick = [&]() -> const std::vector<float>& {
    switch (array) {
      case RenderArray::kDifference:
      case RenderArray::kMagnitude: return potential_difference;
      case RenderArray::kSource: return potential_source;
      case RenderArray::kTarget: return potential_target;
      case RenderArray::kSign: return sign_change;
      case RenderArray::kDisplacement: return displacement;
      case RenderArray::kResidue: return residue_index;
      case RenderArray::kPlain: break;
    }
    return nothing;
  };
  if (pick().empty() && array != RenderArray::kPlain) {
    throw InputError(path + ": no point array '" + array_name(array) + "' (there are: " + array_names +
                     "); colour by another, or compare with --source-map and --target-map");
  }
  return pick();
}

SurfaceFile read_surface_file(const std::string& path) {
  check_exists(path);
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  if (reader->CanReadFile(path.c_str()) == 0) {
    throw FormatError(path, 0, "not a VTK PolyData file (.vtp); `espdiff compare SOURCE TARGET -o OUT` writes OUT.vtp");
  }
  reader->Update();
  if (messages.has_error())
    throw FormatError(path, 0, "damaged .vtp file (" + messages.first_error() + "); write it again");

  vtkPolyData* surface = reader->GetOutput();
  SurfaceFile file;
  file.path = path;
  file.triangles = triangles_of(path, surface);
  if (file.triangles.empty()) throw FormatError(path, 0, "the surface has no triangles; nothing to draw");
  file.positions = positions_of(path, surface);
  read_arrays(file, surface);
  const auto& lost = file.unmatched;
  if (!lost.empty() && std::find(lost.begin(), lost.end(), 0) == lost.end()) {
    throw FormatError(path, 0, "no triangle has a counterpart; nothing to draw");
  }
  return file;
}

}  // namespace espdiff
