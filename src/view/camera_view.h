// camera_view.h: where the camera of a scene stands.
#pragma once

#include <vector>

#include "view/scene.h"

class vtkRenderer;

namespace espdiff {

/// The scene's camera, or an automatic one: principal axes of the surface, the side with more colour in front, large
/// enough for every view; then turned, tilted and zoomed as the scene says.
/// @param positions [vertex] Angstrom; @param values [vertex] what the surface is coloured by, or empty
/// @param aspect    height / width of a view
CameraView choose_camera(const Scene& scene, const std::vector<Vec3d>& positions, const std::vector<float>& values,
                         double aspect);

/// Half of the height that a view must show so that all positions are in it, looked at from where the camera is.
double height_that_fits(const CameraView& view, const std::vector<Vec3d>& positions, double aspect);

/// Places a renderer's camera, a parallel one, so that lengths are the same everywhere.
/// @param angle about the vertical, radians
void place_camera(vtkRenderer* renderer, const CameraView& view, double angle);

/// From where a renderer looks now, for a scene file.
CameraView camera_of(vtkRenderer* renderer);

/// Two lights that move with the camera: those of shaders/blinn_phong.glsl, for what VTK's own mappers draw.
void add_lights(vtkRenderer* renderer);

}  // namespace espdiff
