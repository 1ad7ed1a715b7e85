// surface_geometry.h: a mapped surface for SurfaceMapper: both positions of every vertex, and their coordinates in the
// maps.
#pragma once

#include <vtkSmartPointer.h>

#include <memory>
#include <vector>

#include "io/structures/run_record.h"
#include "scene/map_pair.h"
#include "scene/surface_cover.h"
#include "scene/surface_file.h"
#include "view/surface/surface_mapper.h"

class vtkPolyData;

namespace espdiff {

/// The source's surface superposed on the target: the start of a morph.
struct StartSurface {
  std::vector<Vec3f> positions;  ///< [vertex] in the target's frame
  std::vector<Vec3f> normals;    ///< [vertex] unit, outward
};

/// Without source positions or a recorded superposition: the mapped surface itself.
StartSurface superposed_start(const SurfaceFile& surface, const RunRecord& record);

/// The surface moved outward along its normals, on both molecules; potentials are then compared there. The arrays keep
/// the surface's own values; only maps give values farther out.
/// @param surface with source positions
std::unique_ptr<SurfaceFile> moved_outward(const SurfaceFile& surface, const StartSurface& start,
                                           const RigidTransform& source_to_target, double offset_A);

/// The triangles of one part with the point arrays of kSurfaceAttributes. Triangles on the smooth border of an
/// unmatched part are in both parts, and the shaders draw each half once. Parts with the same `points` share their
/// memory, on the host and on the GPU.
class SurfaceGeometry {
 public:
  /// @param outlined residues whose border is drawn as a line; empty for none
  SurfaceGeometry(const SurfaceFile& surface, const RunRecord& record, const MapPair& maps,
                  const std::vector<int>& outlined = {});

  /// Has no triangles if the surface has no such part.
  vtkSmartPointer<vtkPolyData> part(SurfacePart part) const;
  bool has(SurfacePart part) const;
  /// Whether a matched triangle is not trusted.
  bool has_untrusted() const;
  const StartSurface& start() const { return start_; }
  /// Where vertices are drawn on the target, those of unmatched parts too.
  const SurfaceCover& cover() const { return cover_; }
  /// Whether all vertices, and hence all points between them, lie inside both maps.
  bool inside_maps() const { return inside_maps_; }

 private:
  bool draws(SurfacePart part, std::size_t triangle) const;

  const SurfaceFile& surface_;
  StartSurface start_;
  SurfaceCover cover_;
  bool inside_maps_ = true;
  vtkSmartPointer<vtkPolyData> points_;
};

}  // namespace espdiff
