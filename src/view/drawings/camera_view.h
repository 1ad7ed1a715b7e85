// camera_view.h: the camera of a scene.
#pragma once

#include <vector>

#include "scene/scene.h"

class vtkRenderer;

namespace espdiff {

/// The scene's camera, or an automatic one: principal axes of the surface, the more coloured side in front, large
/// enough for every view; then turned, tilted and zoomed as the scene says.
/// @param positions [vertex] Angstrom; @param values [vertex] the values shown as colours, or empty
/// @param aspect    height / width of a view
CameraView choose_camera(const Scene& scene, const std::vector<Vec3d>& positions, const std::vector<float>& values,
                         double aspect);

/// Half the height that a view must show so that all positions fit, for this camera direction.
double height_that_fits(const CameraView& view, const std::vector<Vec3d>& positions, double aspect);

/// Places a renderer's camera with parallel projection, so that lengths are the same everywhere.
/// @param angle about the vertical, radians
void place_camera(vtkRenderer* renderer, const CameraView& view, double angle);

/// The renderer's current camera, for a scene file.
CameraView camera_of(vtkRenderer* renderer);

/// Adds two lights that move with the camera, as in shaders/blinn_phong.glsl, for VTK's own mappers.
void add_lights(vtkRenderer* renderer);

}  // namespace espdiff
