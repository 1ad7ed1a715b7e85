// map_drawings.h: drawings of a potential map itself: isopotential surfaces, slices, field lines.
#pragma once

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "base/types.h"
#include "scene/colour_scale.h"
#include "view/drawings/camera_view.h"

class vtkPolyData;
class vtkProp;

namespace espdiff {

/// A map placed in the frame of the picture.
struct PlacedMap {
  const Grid* map = nullptr;
  RigidTransform to_frame;  ///< from the map's own frame

  /// Transforms a position of the picture's frame to the map's.
  Vec3d in_map(Vec3d p) const;
  /// Rotates a field's direction from the map's frame to the picture's.
  Vec3d turned(Vec3d direction) const { return to_frame.rotate(direction); }
};

/// The isosurface of a value, translucent in the scale's colour of that value. nullptr if there is none.
vtkSmartPointer<vtkProp> make_isopotential(const PlacedMap& map, double value, const ColourScale& scale);

/// The map on a plane across the view, at a fraction `depth` (0 to 1) through a sphere around the visible surface; a
/// square of 400 x 400 cells, where the map has values.
vtkSmartPointer<vtkProp> make_slice(const PlacedMap& map, const CameraView& view, double radius_A, double depth,
                                    const ColourScale& scale);

/// Lines as thin tubes coloured by the potential along them. nullptr if there are none.
vtkSmartPointer<vtkProp> make_field_lines(const PlacedMap& map, const std::vector<std::vector<Vec3d>>& lines,
                                          const ColourScale& scale);

}  // namespace espdiff
