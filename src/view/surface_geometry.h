// surface_geometry.h: a mapped surface as SurfaceMapper draws it: both places of every vertex, and where they lie in
// the maps.
#pragma once

#include <vtkSmartPointer.h>

#include <memory>
#include <vector>

#include "view/map_pair.h"
#include "view/run_record.h"
#include "view/surface_file.h"
#include "view/surface_mapper.h"

class vtkPolyData;

namespace espdiff {

/// The source's surface superposed on the target: what a morph starts from.
struct StartSurface {
  std::vector<Vec3f> positions;  ///< [vertex] in the target's frame
  std::vector<Vec3f> normals;    ///< [vertex] unit, outward
};

/// Without source positions or a record of the superposition: the mapped surface itself.
StartSurface superposed_start(const SurfaceFile& surface, const RunRecord& record);

/// The surface moved outward along its normals, on both molecules: where the potentials are compared instead. The
/// arrays keep the surface's own values; only maps tell those farther out.
/// @param surface with source positions
std::unique_ptr<SurfaceFile> moved_outward(const SurfaceFile& surface, const StartSurface& start,
                                           const RigidTransform& source_to_target, double offset_A);

/// The triangles of one part with the point arrays of kSurfaceAttributes. Parts that are made of the same `points`
/// share their memory, here and on the graphics processor.
class SurfaceGeometry {
 public:
  SurfaceGeometry(const SurfaceFile& surface, const RunRecord& record, const MapPair& maps);

  /// Without triangles where the surface has no such part.
  vtkSmartPointer<vtkPolyData> part(SurfacePart part) const;
  bool has(SurfacePart part) const;
  const StartSurface& start() const { return start_; }
  /// Whether all vertices, and hence all between them, lie inside of both maps.
  bool inside_maps() const { return inside_maps_; }

 private:
  SurfacePart part_of(std::size_t triangle) const;

  const SurfaceFile& surface_;
  StartSurface start_;
  bool inside_maps_ = true;
  vtkSmartPointer<vtkPolyData> points_;
};

}  // namespace espdiff
