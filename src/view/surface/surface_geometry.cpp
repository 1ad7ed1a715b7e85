// surface_geometry.cpp: fills the point arrays of the shaders.
#include "view/surface/surface_geometry.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/smooth_field.h"
#include "scene/map_sampling.h"
#include "scene/reasons.h"

namespace espdiff {
namespace {

/// Area-weighted mean of the triangles' normals at each vertex.
std::vector<Vec3f> vertex_normals(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
  std::vector<Vec3d> sums(positions.size());
  for (const Triangle& t : triangles) {
    const Vec3d area = cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]);
    for (const std::uint32_t corner : t) sums[corner] += area;
  }
  std::vector<Vec3f> normals(positions.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double length = norm(sums[i]);
    if (length > 0) normals[i] = static_cast<Vec3f>((1 / length) * sums[i]);
  }
  return normals;
}

/// Adds a point array and returns it for filling.
vtkFloatArray* add_array(vtkPolyData* data, const char* name, int n_components) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(n_components);
  array->SetNumberOfTuples(data->GetNumberOfPoints());
  data->GetPointData()->AddArray(array);
  return array;
}

void add_vectors(vtkPolyData* data, const char* name, const std::vector<Vec3f>& vectors) {
  vtkFloatArray* array = add_array(data, name, 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    array->SetTuple3(static_cast<vtkIdType>(i), vectors[i].x, vectors[i].y, vectors[i].z);
  }
}

/// Texture coordinates: (i + 0.5) / n at grid point i of n. @returns whether all lie inside the map
bool add_places(vtkPolyData* data, const char* name, const Grid* map, const std::vector<Vec3d>& positions) {
  std::vector<Vec3f> places(static_cast<std::size_t>(data->GetNumberOfPoints()));
  bool all_inside = true;
  if (map != nullptr) {
    const LatticeIndex index(map->lattice, map->name);
    const auto& size = map->lattice.size;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3d at = index(positions[i]);
      places[i] = static_cast<Vec3f>(Vec3d{(at.x + 0.5) / size[0], (at.y + 0.5) / size[1], (at.z + 0.5) / size[2]});
      for (int axis = 0; axis < 3; ++axis) {
        all_inside = all_inside && at[axis] >= 0 && at[axis] <= size[static_cast<std::size_t>(axis)] - 1;
      }
    }
  }
  add_vectors(data, name, places);
  return all_inside;
}

/// Replaces NaN by `missing`.
void add_numbers(vtkPolyData* data, const char* name, const std::vector<float>& numbers, float missing) {
  vtkFloatArray* array = add_array(data, name, 1);
  array->FillValue(missing);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::isfinite(numbers[i])) array->SetValue(static_cast<vtkIdType>(i), numbers[i]);
  }
}

/// A vertex's two potentials. If a file holds only the difference, they are made up to have that difference, with equal
/// or opposite signs as the file says.
std::array<float, 2> potentials_at(const SurfaceFile& surface, std::size_t i) {
  if (!surface.potential_source.empty() && !surface.potential_target.empty()) {
    return {surface.potential_source[i], surface.potential_target[i]};
  }
  const float difference = surface.potential_difference[i];
  const bool changes = !surface.sign_change.empty() && surface.sign_change[i] != 0;
  return changes ? std::array<float, 2>{-difference / 2, difference / 2} : std::array<float, 2>{0, difference};
}

void add_potentials(vtkPolyData* data, const SurfaceFile& surface) {
  vtkFloatArray* array = add_array(data, "vertexPotential", 3);
  array->FillValue(0);
  if (surface.potential_difference.empty() && (surface.potential_source.empty() || surface.potential_target.empty()))
    return;
  std::vector<float> sources, targets;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const auto [source, target] = potentials_at(surface, i);
    sources.push_back(source);
    targets.push_back(target);
  }
  sources = filled_at_border(surface, std::move(sources));
  targets = filled_at_border(surface, std::move(targets));
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const float source = sources[i], target = targets[i];
    if (std::isfinite(source) && std::isfinite(target)) array->SetTuple3(static_cast<vtkIdType>(i), source, target, 1);
  }
}

/// What the shaders cut, outline and mark: shares of matched surroundings, of outlined residues (negative: none), and
/// of trusted surroundings.
void add_borders(vtkPolyData* data, const SurfaceCover& cover, const std::vector<float>& outlined) {
  vtkFloatArray* array = add_array(data, "borders", 3);
  for (std::size_t i = 0; i < cover.matched.size(); ++i)
    array->SetTuple3(static_cast<vtkIdType>(i), cover.matched[i], outlined.empty() ? -1 : outlined[i],
                     cover.trusted[i]);
}

/// Smooth shares of the reasons but the first, "trusted", which has the rest.
void add_reasons(vtkPolyData* data, const SurfaceFile& surface) {
  std::array<std::vector<float>, kNumberOfDrawnReasons> shares;
  if (!surface.why.empty())
    shares = shares_of_reasons({surface.triangles, surface.why, surface.turned}, surface.positions.size());
  for (const std::size_t first : {1U, 5U}) {
    vtkFloatArray* array = add_array(data, first == 1 ? "reasonsA" : "reasonsB", 4);
    for (std::size_t v = 0; v < surface.positions.size(); ++v) {
      const auto share = [&](std::size_t r) { return shares[r].empty() ? 0.0F : shares[r][v]; };
      array->SetTuple4(static_cast<vtkIdType>(v), share(first), share(first + 1), share(first + 2), share(first + 3));
    }
  }
}

std::vector<Vec3f> floats(const std::vector<Vec3d>& vectors) {
  std::vector<Vec3f> result;
  result.reserve(vectors.size());
  for (const Vec3d& v : vectors) result.push_back(static_cast<Vec3f>(v));
  return result;
}

}  // namespace

StartSurface superposed_start(const SurfaceFile& surface, const RunRecord& record) {
  if (surface.source_positions.empty() || !record.found) return {floats(surface.positions), surface.normals};
  std::vector<Vec3d> placed;
  placed.reserve(surface.source_positions.size());
  for (const Vec3d& p : surface.source_positions) placed.push_back(record.source_to_target.apply(p));
  if (surface.source_normals.empty()) return {floats(placed), vertex_normals(placed, surface.triangles)};
  StartSurface start{floats(placed), {}};
  for (const Vec3f& n : surface.source_normals)
    start.normals.push_back(static_cast<Vec3f>(record.source_to_target.rotate(static_cast<Vec3d>(n))));
  return start;
}

std::unique_ptr<SurfaceFile> moved_outward(const SurfaceFile& surface, const StartSurface& start,
                                           const RigidTransform& source_to_target, double offset_A) {
  auto moved = std::make_unique<SurfaceFile>(surface);
  const double* r = source_to_target.rotation;
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    moved->positions[i] += offset_A * static_cast<Vec3d>(surface.normals[i]);
    const auto n = static_cast<Vec3d>(start.normals[i]);
    // Rotates back into the source's own frame (transpose).
    moved->source_positions[i] +=
        offset_A * Vec3d{r[0] * n.x + r[3] * n.y + r[6] * n.z, r[1] * n.x + r[4] * n.y + r[7] * n.z,
                         r[2] * n.x + r[5] * n.y + r[8] * n.z};
  }
  return moved;
}

SurfaceGeometry::SurfaceGeometry(const SurfaceFile& surface, const RunRecord& record, const MapPair& maps,
                                 const std::vector<int>& outlined)
    : surface_(surface),
      start_(superposed_start(surface, record)),
      cover_(cover_of(surface, start_.positions)),
      points_(vtkSmartPointer<vtkPolyData>::New()) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(surface.positions.size()));
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const Vec3d p = cover_.positions[i];
    points->SetPoint(static_cast<vtkIdType>(i), p.x, p.y, p.z);
  }
  points_->SetPoints(points);
  add_vectors(points_, "normal", cover_.normals);
  points_->GetPointData()->SetActiveNormals("normal");
  add_vectors(points_, "startMC", start_.positions);
  add_vectors(points_, "startNormalMC", start_.normals);
  const bool source_inside = add_places(points_, "sourcePlace", maps.source.get(), surface.source_positions);
  const bool target_inside = add_places(points_, "targetPlace", maps.target.get(), cover_.positions);
  inside_maps_ = source_inside && target_inside;
  add_potentials(points_, surface);
  add_numbers(points_, "displacement", filled_at_border(surface, surface.displacement), -1);
  add_numbers(points_, "slip", filled_at_border(surface, surface.slip), -1);
  // Significance ends at a line and is not smoothed.
  add_numbers(points_, "uncertainty",
              surface.p_family_wise.empty()
                  ? filled_at_border(surface, drawn_uncertainty(surface.triangles, surface.uncertainty()))
                  : surface.p_family_wise,
              -1);
  add_numbers(points_, "residueIndex", surface.residue_index, -1);
  add_borders(points_, cover_, share_of_residues(surface, outlined));
  add_reasons(points_, surface);
}

bool SurfaceGeometry::draws(SurfacePart part, std::size_t triangle) const {
  if (surface_.unmatched.empty()) return part == SurfacePart::kMatched;
  float low = 1, high = 0;
  for (const std::uint32_t corner : surface_.triangles[triangle]) {
    low = std::min(low, cover_.matched[corner]);
    high = std::max(high, cover_.matched[corner]);
  }
  return part == SurfacePart::kMatched ? high >= 0.5F : part == SurfacePart::kUnmatched && low < 0.5F;
}

bool SurfaceGeometry::has(SurfacePart part) const {
  for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
    if (surface_.is_matched(i) == (part == SurfacePart::kMatched)) return true;
  }
  return false;
}

bool SurfaceGeometry::has_untrusted() const {
  for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
    if (surface_.is_matched(i) && surface_.is_untrusted(i)) return true;
  }
  return false;
}

vtkSmartPointer<vtkPolyData> SurfaceGeometry::part(SurfacePart part) const {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->ShallowCopy(points_);
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
    if (!draws(part, i)) continue;
    const Triangle& t = surface_.triangles[i];
    cells->InsertNextCell({static_cast<vtkIdType>(t[0]), static_cast<vtkIdType>(t[1]), static_cast<vtkIdType>(t[2])});
  }
  data->SetPolys(cells);
  return data;
}

}  // namespace espdiff
